#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "server/replay/moment_filler.h"
#include "server/replay/replay_player.h"
#include "server/session/core/playback.h"
#include "server/session/core/session_core.h"

namespace vat {

/// Replay of a recording in a session. The recorded participants are kept apart from the viewers.
/// Used by one thread at a time.
class ReplayRun final : public Playback {
 public:
  /// The contents of `environment` must outlive this.
  ReplayRun(std::shared_ptr<const Recording> recording, const SessionEnvironment& environment);

  /// Returns the simulation to make the core with. Throws StorageError.
  Simulation begin() const { return player_.begin(); }
  /// Moves the core to the begin of the recording, paused, and starts to fill it with moments.
  void start(SessionCore& core);

  Range range() const override { return {recording_->begin, recording_->end}; }
  bool tick(SessionCore& core, SteadyClock::time_point now, bool timed) override;
  void begin_seek(SessionCore& core, std::uint64_t position) override;
  bool continue_seek(SessionCore& core, CostClock::time_point until) override;
  void end_seek(SessionCore& core) override;
  std::optional<std::uint64_t> find_tick(const SessionCore& core,
                                         std::uint64_t tick) const override;
  Json describe(const SessionCore& core) const override;
  void tell_people(SessionCore& core, SteadyClock::time_point now) override;

 private:
  /// Runs `action` with the recorded participants and clock. Returns false if the state differs
  /// from the recording.
  template <class Action>
  bool with_recorded(SessionCore& core, Action&& action);
  /// Pauses the session and sends replay.diverged.
  void diverge(SessionCore& core, const std::string& reason);
  void read_names();
  Json describe_people(const SessionCore& core) const;

  const std::shared_ptr<const Recording> recording_;
  const SessionEnvironment environment_;
  const std::shared_ptr<MomentCache> moments_;
  ReplayPlayer player_;
  std::map<ParticipantNumber, std::string> names_;
  const std::atomic<bool> cancelled_ = false;
  std::uint64_t target_ = 0;        // of a seek
  std::uint32_t epoch_ = 1;         // the last one shown
  std::optional<Json> divergence_;  // the params of replay.diverged
  std::string told_people_;
  SteadyClock::time_point told_at_{};
  std::unique_ptr<MomentFiller> filler_;
};

}  // namespace vat
