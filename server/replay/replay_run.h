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

/// Replay of a recording in a session. The recorded participants are separate from the viewers. Not
/// thread-safe.
class ReplayRun final : public Playback {
 public:
  /// The objects to which `environment` refers must outlive the replay.
  ReplayRun(std::shared_ptr<const Recording> recording, const SessionEnvironment& environment);

  /// Returns the initial simulation of the SessionCore. Throws StorageError.
  Simulation begin() const { return player_.begin(); }
  /// Sets the core to the start of the recording, paused. Starts a MomentFiller.
  void start(SessionCore& core);

  Range range() const override { return {recording_->begin, recording_->end}; }
  bool tick(SessionCore& core, SteadyClock::time_point now, bool timed) override;
  void begin_seek(SessionCore& core, std::uint64_t position) override;
  bool continue_seek(SessionCore& core, CostClock::time_point until) override;
  void end_seek(SessionCore& core) override;
  std::optional<std::uint64_t> find_tick(const SessionCore& core,
                                         std::uint64_t tick) const override;
  std::size_t cached_bytes() const override { return moments_->bytes(); }
  Json describe(const SessionCore& core) const override;
  void tell_people(SessionCore& core, SteadyClock::time_point now) override;

 private:
  /// Runs `action` with the recorded participants and clock. Returns false if the state differs
  /// from the recording.
  template <class Action>
  bool with_recorded(SessionCore& core, Action&& action);
  /// Pauses the session and sends the event replay.diverged.
  void diverge(SessionCore& core, const std::string& reason);
  void read_names();
  Json describe_people(const SessionCore& core) const;

  const std::shared_ptr<const Recording> recording_;
  const SessionEnvironment environment_;
  const std::shared_ptr<MomentCache> moments_;
  ReplayPlayer player_;
  std::map<ParticipantNumber, std::string> names_;
  const std::atomic<bool> cancelled_ = false;
  std::uint64_t target_ = 0;        // target position of a seek
  std::uint32_t epoch_ = 1;         // last epoch sent to clients
  std::optional<Json> divergence_;  // parameters of replay.diverged
  std::string told_people_;
  SteadyClock::time_point told_at_{};
  std::unique_ptr<MomentFiller> filler_;
};

}  // namespace vat
