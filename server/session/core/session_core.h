#pragma once

#include <span>
#include <string>
#include <vector>

#include "server/session/core/session_command.h"
#include "server/session/core/session_people.h"

namespace vat {

class Playback;

/// A session without its threads: simulation, clock, participants, history and notifications, and
/// the operations that concern several of them. Used by one thread at a time.
class SessionCore {
 public:
  /// `share` is the session's part of the budget of all sessions. The environment must outlive
  /// this.
  SessionCore(std::string id, SessionSettings settings, Simulation simulation, ResourceShare share,
              const SessionEnvironment& environment);
  /// Takes the share that the simulation needs, even beyond the limits.
  SessionCore(std::string id, SessionSettings settings, Simulation simulation,
              const SessionEnvironment& environment);
  SessionCore(const SessionCore&) = delete;
  SessionCore& operator=(const SessionCore&) = delete;

  const std::string& id() const { return context_.id; }
  const SessionEnvironment& environment() const { return *context_.environment; }
  void set_environment(const SessionEnvironment& environment);
  /// Null unless the session is a replay.
  Playback* playback() const { return context_.playback; }
  void set_playback(Playback* playback) { context_.playback = playback; }
  /// The session's strand holds this ownership during a turn. All functions check it.
  ThreadOwner& owner() { return context_.owner; }

  SessionRun& run() { return run_; }
  const SessionRun& run() const { return run_; }
  SessionClock& clock() { return clock_; }
  const SessionClock& clock() const { return clock_; }
  Participants& participants() { return participants_; }
  const Participants& participants() const { return participants_; }
  /// Participants of a replay's recording. participants() are its viewers.
  Participants& recorded() { return recorded_; }
  const Participants& recorded() const { return recorded_; }
  SessionHistory& history() { return history_; }
  const SessionHistory& history() const { return history_; }
  SessionNotifier& notifier() { return notifier_; }
  SessionPeople& people() { return people_; }

  void set_playing(bool playing);
  void set_speed(double speed);
  /// Replaces the simulation; ticks count from 0.
  void load(Simulation simulation);
  /// Replaces the simulation by `simulation`, which has run `tick` ticks since the state
  /// `as_loaded`.
  void restore(Simulation simulation, const Simulation& as_loaded, std::uint64_t tick);
  void reset();
  /// Starts an epoch because bodies were added, removed or changed. `moved`: some bodies were moved
  /// by a command and not by a tick, so that their accelerations are unknown.
  void start_epoch(bool moved = false);
  /// Runs one tick, whose frame is then due. Returns false if the guard failed, which pauses the
  /// session. The rate is measured only if `timed` is true, because ticks of control.step are not
  /// timed.
  bool tick(SteadyClock::time_point now, bool timed);

  /// Logs and executes commands between two ticks. If they cannot be logged, all are refused.
  std::vector<ActionResult> execute(std::span<const ParticipantCommand> commands);
  /// Executes a logged command, either when it is issued or when a log is replayed. Adds the
  /// participant if it is missing.
  ActionResult execute(const LogEntry& entry, const SessionAction& action);
  /// Ends grabs without `grab.move` during the idle time. Logs each end as a command of the grab's
  /// participant.
  void end_idle_grabs(SteadyClock::time_point now);

 private:
  void start_scene();
  ActionResult act(ParticipantNumber participant, const SessionAction& action);

  SessionContext context_;
  SessionRun run_;
  SessionClock clock_;
  Participants participants_;
  Participants recorded_;
  SessionHistory history_;
  SessionNotifier notifier_;
  SessionPeople people_;
};

}  // namespace vat
