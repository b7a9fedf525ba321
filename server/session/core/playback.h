#pragma once

#include <cstdint>
#include <optional>

#include "protocol/json/json_reader.h"
#include "server/support/clock.h"

namespace vat {

class SessionCore;

/// Plays a recording in a session in place of new ticks. Implemented by server/replay/. Positions
/// count the ticks of the recorded session. Used by one thread at a time.
class Playback {
 public:
  struct Range {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;  ///< at least `begin`
  };

  virtual ~Playback() = default;
  /// First and last position of the recording.
  virtual Range range() const = 0;
  /// Runs the next recorded tick. Pauses the session at the end of the recording, and if the state
  /// differs from the recorded one. Returns false if no tick was run.
  virtual bool tick(SessionCore& core, SteadyClock::time_point now, bool timed) = 0;

  /// Starts to move the session to a position. Clients see nothing before end_seek().
  virtual void begin_seek(SessionCore& core, std::uint64_t position) = 0;
  /// Continues the seek until the time `until`. Returns true if the session is at the target, or if
  /// its state differs from the recording.
  virtual bool continue_seek(SessionCore& core, CostClock::time_point until) = 0;
  virtual void end_seek(SessionCore& core) = 0;
  /// Returns the position of a tick of the current run. A reset or another scene ends a run.
  virtual std::optional<std::uint64_t> find_tick(const SessionCore& core,
                                                 std::uint64_t tick) const = 0;

  /// Returns the result of replay.info.
  virtual Json describe(const SessionCore& core) const = 0;
  /// Sends replay.people if the recorded participants have changed, at most ten times a second.
  virtual void tell_people(SessionCore& core, SteadyClock::time_point now) = 0;
};

}  // namespace vat
