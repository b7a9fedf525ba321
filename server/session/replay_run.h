#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "server/replay/moment_filler.h"
#include "server/replay/replay_player.h"
#include "server/session/session_core.h"

namespace vat {

/// What makes a session one that shows a recording: its ticks are those that were recorded, by
/// people who are told apart from those who watch. Used by one thread at a time.
class ReplayRun {
 public:
  /// What the environment is made of must outlive this.
  ReplayRun(std::shared_ptr<const Recording> recording, const SessionEnvironment& environment);

  const Recording& recording() const { return *recording_; }
  /// What the core is to be made with. Throws StorageError.
  Simulation begin() const { return player_.begin(); }
  /// Takes the core to where the recording begins, paused, and fills it with moments from now on.
  void start(SessionCore& core);

  /// Where it is at its end, or is not what was recorded, the session pauses, and is told so.
  bool tick(SessionCore& core, SteadyClock::time_point now, bool timed);

  /// Goes to a position in parts, which nobody but who asks for the status sees anything of; true
  /// where it is there, or cannot go on.
  void begin_seek(SessionCore& core, std::uint64_t position);
  bool seek_on(SessionCore& core, CostClock::time_point until);
  void end_seek(SessionCore& core);
  /// The position of a tick within the present run, which a reset or another scene ends.
  std::optional<std::uint64_t> find_tick(const SessionCore& core, std::uint64_t tick) const;

  /// As replay.info tells it.
  Json describe(const SessionCore& core) const;
  /// Tells of the people where they have changed, ten times a second at most.
  void tell_people(SessionCore& core, SteadyClock::time_point now);

 private:
  /// True where that led on as recorded.
  template <class Action>
  bool in_the_past(SessionCore& core, Action&& action);
  void differ(SessionCore& core, const std::string& reason);
  void read_names();
  Json describe_people(const SessionCore& core) const;

  const std::shared_ptr<const Recording> recording_;
  const SessionEnvironment environment_;
  const std::shared_ptr<KeptMoments> moments_;
  ReplayPlayer player_;
  std::map<ParticipantNumber, std::string> names_;
  const std::atomic<bool> cancelled_ = false;
  std::uint64_t target_ = 0;     // of a seek
  std::uint32_t epoch_ = 1;      // that was shown last
  std::optional<Json> differs_;  // the params of replay.diverged
  std::string told_people_;
  SteadyClock::time_point told_at_{};
  std::unique_ptr<MomentFiller> filler_;
};

}  // namespace vat
