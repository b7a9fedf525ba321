#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "protocol/json/json_reader.h"
#include "server/support/clock.h"

namespace vat {

class SessionCore;

/// Playback of a recording in a session, instead of new ticks. Positions count the ticks of the
/// recorded session. Implemented in server/replay/. Not thread-safe.
class Playback {
 public:
  struct Range {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;  ///< at least `begin`
  };

  virtual ~Playback() = default;
  /// Returns the first and the last position of the recording.
  virtual Range range() const = 0;
  /// Runs the next recorded tick. Pauses the session at the end of the recording, or if the state
  /// differs from the recorded state. Returns false if no tick was run.
  virtual bool tick(SessionCore& core, SteadyClock::time_point now, bool timed) = 0;

  /// Starts to move the session to a position. Clients receive no updates before end_seek().
  virtual void begin_seek(SessionCore& core, std::uint64_t position) = 0;
  /// Continues the seek until the time `until`. Returns true if the session is at the target, or if
  /// its state differs from the recording.
  virtual bool continue_seek(SessionCore& core, CostClock::time_point until) = 0;
  virtual void end_seek(SessionCore& core) = 0;
  /// Returns the recorded position of a tick of the current run. A run ends with a reset or another
  /// scene.
  virtual std::optional<std::uint64_t> find_tick(const SessionCore& core,
                                                 std::uint64_t tick) const = 0;

  /// Returns the size of the stored states of the recording [bytes].
  virtual std::size_t cached_bytes() const = 0;

  /// Returns the result of the method replay.info.
  virtual Json describe(const SessionCore& core) const = 0;
  /// Sends the event replay.people if the recorded participants have changed, at most ten times per
  /// second.
  virtual void tell_people(SessionCore& core, SteadyClock::time_point now) = 0;
};

}  // namespace vat
