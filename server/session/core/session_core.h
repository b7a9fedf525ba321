#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/session/core/session_command.h"
#include "server/session/core/session_people.h"

namespace vat {

class Playback;

/// Commands that are logged and executed together.
struct CommandBatch {
  struct Item {
    ParticipantCommand command;
    std::optional<SessionAction> action;  ///< if present, replaces the command's action
    std::optional<RpcError> error;        ///< if present, the command is refused without an entry
  };
  std::vector<Item> items;
  std::vector<LogEntry> entries;  ///< one for each logged command without an error
};

/// Session without its threads: simulation, clock, participants, history and notifications.
/// Contains the operations that concern several of these parts. Not thread-safe.
class SessionCore {
 public:
  /// `share` is the session's part of the server's resource budget. The environment must outlive
  /// the session.
  SessionCore(std::string id, SessionSettings settings, Simulation simulation, ResourceShare share,
              const SessionEnvironment& environment);
  /// Reserves the resources that the simulation needs, even beyond the server's limits.
  SessionCore(std::string id, SessionSettings settings, Simulation simulation,
              const SessionEnvironment& environment);
  SessionCore(const SessionCore&) = delete;
  SessionCore& operator=(const SessionCore&) = delete;

  const std::string& id() const { return context_.id; }
  const SessionEnvironment& environment() const { return *context_.environment; }
  void set_environment(const SessionEnvironment& environment);
  /// Returns the playback of a replay. Returns null for other sessions.
  Playback* playback() const { return context_.playback; }
  void set_playback(Playback* playback) { context_.playback = playback; }
  /// Returns the ownership of the session, which the strand's thread holds during a turn (see
  /// Session). The functions of the session's parts check the ownership.
  ThreadOwner& owner() { return context_.owner; }

  SessionRun& run() { return run_; }
  const SessionRun& run() const { return run_; }
  SessionClock& clock() { return clock_; }
  const SessionClock& clock() const { return clock_; }
  Participants& participants() { return participants_; }
  const Participants& participants() const { return participants_; }
  /// Returns the participants of a replay's recording. participants() returns the viewers of the
  /// replay.
  Participants& recorded() { return recorded_; }
  const Participants& recorded() const { return recorded_; }
  SessionHistory& history() { return history_; }
  const SessionHistory& history() const { return history_; }
  SessionNotifier& notifier() { return notifier_; }
  SessionPeople& people() { return people_; }

  void set_playing(bool playing);
  void set_speed(double speed);
  /// Replaces the simulation and sets the tick count to 0.
  void load(Simulation simulation);
  /// Replaces the simulation. The new simulation has run `tick` ticks since the state `as_loaded`.
  void restore(Simulation simulation, const Simulation& as_loaded, std::uint64_t tick);
  void reset();
  /// Starts an epoch because bodies were added, removed or changed. An epoch is a period with one
  /// description of the bodies. `moved` must be true if a command moved bodies, because their
  /// accelerations are then unknown.
  void start_epoch(bool moved = false);
  /// Runs one tick without publishing its frame. If the guard (core/guard/guard.h) fails, pauses
  /// the session and returns false. Measures the rate only if `timed` is true, because ticks of
  /// control.step are not timed.
  bool tick(SteadyClock::time_point now, bool timed);

  /// Prepares commands for execution together. The commands must outlive the result.
  CommandBatch prepare(std::span<const ParticipantCommand> commands) const;
  /// Executes a batch between two ticks. `entries` are the batch's entries, which have been stored.
  /// If they could not be stored, refuses the logged commands with `failure`.
  std::vector<ActionResult> execute(const CommandBatch& batch, std::span<const LogEntry> entries,
                                    const std::optional<RpcError>& failure = {});
  /// Executes a logged command, either a new command or a command of a replayed log. Adds the
  /// participant if the session does not have it.
  ActionResult execute(const LogEntry& entry, const SessionAction& action);
  /// Grab without a `grab.move` during the idle time. A grab is a spring by which a participant
  /// moves a body.
  struct IdleGrab {
    ParticipantNumber participant = 0;
    std::uint64_t grab = 0;
    BodyId body = 0;
  };
  std::vector<IdleGrab> idle_grabs(SteadyClock::time_point now);
  /// Sends grab.ended if the grab has ended.
  void tell_idle_grab(const IdleGrab& idle);

 private:
  void start_scene();
  /// Tells that the device has stopped to take the steps. If it has failed, the log alone no longer
  /// leads to the state.
  void leave_device(const Error& error, SteadyClock::time_point now);
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
