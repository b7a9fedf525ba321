#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "server/session/frame_feed.h"
#include "server/session/method_rules.h"
#include "server/session/participants.h"
#include "server/session/presence.h"
#include "server/session/rpc_message.h"
#include "server/session/session_environment.h"
#include "server/session/session_log.h"
#include "server/session/session_run.h"
#include "server/session/session_settings.h"
#include "server/session/tick_clock.h"

namespace vat {

/// Who takes part in a session, as `server.sessions` tells it.
struct PersonSummary {
  ParticipantNumber number = 0;
  std::string name;
  Role role = Role::viewer;
  std::string address;  ///< empty: it is away
};

/// A session as `session.list` tells it.
struct SessionSummary {
  std::string name;
  std::string scene;
  std::size_t clients = 0;
  bool playing = false;
  std::uint64_t tick = 0;
  std::size_t particles = 0;
  ConnectionId creator = 0;  ///< who is its owner once it joins; 0: nobody
  bool is_replay = false;
  bool hibernating = false;                                  ///< plays, but nobody is in it
  std::optional<SteadyClock::time_point> empty_since;        ///< where nobody is in it, or away
  std::shared_ptr<const std::vector<PersonSummary>> people;  ///< null: nothing is known of them
};

/// Who asks to take part.
struct JoinRequest {
  std::string name;                   ///< empty: one is made up
  std::optional<std::string> resume;  ///< the token of the participant to be resumed
  std::optional<Role> role;           ///< by invitation; absent: the usual one
  bool passes_lock = false;
};

/// What a connection is told of itself when it comes in.
struct Entry {
  const Participant& participant;
  std::string resume;  ///< the token by which another connection takes the participant over
  bool resumed = false;
};

class SessionCore;
class ReplayRun;

/// Ticks that a command asks for before it is answered.
struct RunTicks {
  std::uint64_t count = 0;
};

/// A recording that a command asks for.
struct MakeRecording {};

/// Where a command wants a replay to go.
struct SeekTo {
  std::uint64_t position = 0;
};

/// The session's state, to be kept under a name.
struct SaveState {
  std::string name;
  std::string saved_by;
};

/// A command's reply; a result gets its `tick` afterwards.
using ActionResult = std::variant<Json, RpcError, RunTicks, MakeRecording, SeekTo, SaveState>;

/// What a command does once its parameters are read.
using SessionAction = std::function<ActionResult(SessionCore&, Participant&)>;

/// A call of a session's method with valid parameters.
// NOLINTNEXTLINE(bugprone-exception-escape): the library says that moves of JSON do not throw
struct SessionCommand {
  const MethodRules* rules = nullptr;
  Json params;  ///< an object
  SessionAction action;
};

/// All that a session is but its threads: what is simulated, who takes part, and what they are
/// told. Used by one thread at a time; its clock is given, but for the profile's.
///
/// Commands change it and note what has to be told; announce() then tells all who are here, so that
/// many commands at once make one description, one status and one frame.
class SessionCore {
 public:
  SessionCore(std::string id, SessionSettings settings, Simulation simulation, ResourceShare share,
              const SessionEnvironment& environment);

  /// The same with what it needs of the environment's budget, also beyond its limits.
  SessionCore(std::string id, SessionSettings settings, Simulation simulation,
              const SessionEnvironment& environment);

  const std::string& id() const { return id_; }
  const SessionEnvironment& environment() const { return *environment_; }
  void set_environment(const SessionEnvironment& environment) { environment_ = &environment; }
  /// Runs `task` on a frame thread, after the frames of all states published before.
  void post_behind_frames(std::function<void()> task) { frames_->post(std::move(task)); }
  SessionRun& run() { return run_; }
  const SessionRun& run() const { return run_; }
  Participants& participants() { return participants_; }

  bool is_empty() const { return participants_.connected() == 0 && participants_.away() == 0; }
  bool playing() const { return playing_; }
  double speed() const { return speed_; }
  double real_time_factor() const { return rate_.rate(); }  ///< that is achieved
  void set_playing(bool playing);
  void set_speed(double speed);
  void load(Simulation simulation);
  /// The same with one that has run so many ticks since it was `as_loaded`.
  void restore(Simulation simulation, const Simulation& as_loaded, std::uint64_t tick);
  void reset();
  /// The bodies have changed: a new epoch begins.
  void bodies_changed();
  /// Bodies are elsewhere, or otherwise, than where ticks have led them.
  void state_changed();
  /// What the description tells has changed, but not the bodies.
  void description_changed() { description_due_ = true; }
  /// The id of the next grab, to be started, and to be used up where that succeeds.
  std::uint64_t next_grab() const { return last_grab_ + 1; }
  void use_grab() { ++last_grab_; }

  /// From now on it shows a recording: nothing but its clock can be changed.
  void show(ReplayRun* replay) { replay_ = replay; }
  /// Null where it is no replay.
  const ReplayRun* replay() const { return replay_; }
  /// Those of a replay that were recorded; participants() watch it.
  const Participants& recorded() const { return recorded_; }
  /// While it lives, participants() are those that were recorded.
  class RecordedParticipants {
   public:
    explicit RecordedParticipants(SessionCore& core) : core_(core) {
      core_.exchange_participants();
    }
    ~RecordedParticipants() { core_.exchange_participants(); }
    RecordedParticipants(const RecordedParticipants&) = delete;
    RecordedParticipants& operator=(const RecordedParticipants&) = delete;

   private:
    SessionCore& core_;
  };
  /// Plays or not, and how fast, and nobody is told.
  void set_clock(bool playing, double speed);
  /// All of what is shown is another from now on.
  void begin_epoch(std::uint32_t epoch);

  /// A command that a participant has given.
  struct ParticipantCommand {
    ParticipantNumber participant = 0;
    const SessionCommand& command;
  };
  /// Carries out commands between two ticks, once they are in the log; their results. Where they
  /// cannot be logged, all of them are refused.
  std::vector<ActionResult> carry_out(std::span<const ParticipantCommand> commands);
  /// The one way by which commands change a session, now or when a log is carried out again. The
  /// participant is a ghost where it is not here.
  ActionResult apply(const LogEntry& entry, const SessionAction& action);

  /// Notes that somebody is told of the present tick: the session does not come back before it.
  std::optional<RpcError> reach();

  /// From now on commands are logged, and the session is kept.
  void keep_in(std::unique_ptr<SessionLog> log) { log_ = std::move(log); }
  /// Null where it is kept nowhere.
  SessionLog* log() { return log_.get(); }
  std::unique_ptr<SessionLog> end_log() { return std::move(log_); }
  std::uint64_t sequence() const { return sequence_; }  ///< of the last entry carried out
  bool has_diverged() const { return divergence_.has_value(); }
  SessionMoment moment() const;
  /// Goes on from a moment of the session's past. `as_loaded` is what it resets to.
  void resume(const SessionMoment& moment, Simulation simulation, Snapshot as_loaded);
  /// In a log that is carried out again: where the session was seen last, as far as the log does
  /// not tell it.
  void pass(const SessionProgress& beat);
  /// The log has been carried out again, and the session goes on from here in a new epoch. Those
  /// who took part are away.
  void come_back(SteadyClock::time_point now);
  /// A session that came back in another state than it was in stands still and tells so, until it
  /// is loaded or reset.
  struct Divergence {
    std::uint64_t position = 0;
    std::uint64_t tick = 0;
    std::string reason;
  };
  void set_divergence(Divergence divergence);

  /// A connection comes in, as a further participant or as the one that it resumes, whose other
  /// connection, if it has one, is closed. Ends what the connection was in the session before.
  std::variant<Entry, RpcError> join(const std::shared_ptr<ClientOutbox>& outbox,
                                     std::uint64_t membership, const JoinRequest& join_request,
                                     SteadyClock::time_point now);
  /// The participant of the connection, if there is one, may be resumed for a while.
  void disconnect(ConnectionId client, SteadyClock::time_point now);
  /// Ends the participant's grabs, and the participant.
  /// Where that cannot be logged, the participant is away, and leaves later.
  void leave(ParticipantNumber number);
  /// The same by an entry of the log; and what let_go() does.
  void carry_out_leave(const LogEntry& entry);
  void carry_out_let_go(const LogEntry& entry);
  /// Ends its connection too, told why.
  void kick(ParticipantNumber number, const std::string& reason);
  void rename(Participant& participant, std::string name);
  /// Who may no longer change things lets go of what it held. A session has one owner at most: a
  /// further one takes the place of the one before, who becomes a controller.
  void set_role(Participant& participant, Role role);
  /// Grabs that nobody has moved for too long end, as by a command of their participants.
  void end_idle_grabs(SteadyClock::time_point now);
  Presence& presence() { return presence_; }
  void tell_presence(SteadyClock::time_point now);
  const SessionSettings& settings() const { return settings_; }
  void configure(SessionSettings settings);
  Json describe_settings() const;
  /// Those who have been away for too long leave.
  void end_absences(SteadyClock::time_point now);
  /// The participant gets the present state of a session that pauses, the next of one that plays,
  /// and then those that it asks for. So all who come between two ticks share a key frame, and from
  /// the second frame after it on they share all frames with those who were there before.
  void subscribe(Participant& participant, const Subscription& subscription,
                 SteadyClock::time_point now);
  void unsubscribe(Participant& participant);

  /// Runs one tick; its frame is due then. False if the guard failed, which pauses the session.
  /// The rate is measured where `timed`: ticks of control.step keep no pace.
  bool tick(SteadyClock::time_point now, bool timed);
  void publish_tick();
  /// A tick was run in time by others.
  void time_tick(SteadyClock::time_point now) { rate_.tick_done(now, run_.tick_seconds()); }
  /// The rate is measured anew: the clock has stood still.
  void forget_rate() { rate_ = {}; }
  /// Tells what is due.
  void announce();
  void announce_status();
  /// Ends the connections of participants that have stopped reading.
  void close_silent(SteadyClock::time_point now);
  /// True once after anything that ends the ticks of a control.step: another control command, a
  /// change of scene, a failed guard.
  bool take_interruption();

  Json description() const;
  SessionSummary summary();

 private:
  Json status() const;
  void exchange_participants() { std::swap(participants_, recorded_); }
  void interrupt();
  void tell_description();
  void tell_guard(const AdvanceReport& report);
  void list_people();
  void begin_anew();
  void start_epoch();
  void publish_frame();
  void fill_state();
  Participant& take_in(const ClientOutbox& outbox, const JoinRequest& join_request,
                       std::string& token);
  /// As by a command of the participant, so that it is where commands are.
  void end_grab(ParticipantNumber participant, std::uint64_t grab);
  void release_connection(const Participant& participant, ConnectionId next);
  /// So that those who come and go at once do not grow without bound.
  void bound_absences();
  /// What the log gets of a command, and what it then does.
  struct Prepared {
    LogEntry entry;
    std::optional<SessionAction> action;  ///< in place of the command's
  };
  std::variant<Prepared, RpcError> prepare(const ParticipantCommand& given) const;
  std::variant<Prepared, RpcError> prepare_load(const ParticipantCommand& given) const;
  std::variant<Prepared, RpcError> prepare_restore(const ParticipantCommand& given) const;
  std::optional<RpcError> log(std::span<LogEntry> entries);
  void refuse(const LogEntry& entry);
  ActionResult act(ParticipantNumber participant, const SessionAction& action);
  LogEntry make_entry(ParticipantNumber participant, std::string_view method,
                      std::string params) const;
  void tell_divergence();
  /// Ends the grabs of a participant, who stays.
  void let_go(const Participant& participant);

  const std::string id_;
  SessionSettings settings_;
  const SessionEnvironment* environment_;
  SessionRun run_;
  Participants participants_;
  Participants recorded_;
  ReplayRun* replay_ = nullptr;
  Presence presence_;
  const std::shared_ptr<FrameFeed> frames_;
  StatePublisher publisher_;
  PublishedState state_;  // the next, or what another has left in its place
  RateMeter rate_;
  std::shared_ptr<const std::vector<PersonSummary>> people_;  // as of so many changes
  std::uint64_t people_changes_ = 0;
  bool playing_ = true;
  double speed_ = 1;  // simulated seconds per second
  std::uint64_t last_grab_ = 0;
  std::unique_ptr<SessionLog> log_;
  std::uint64_t sequence_ = 1;  // of the last entry that was carried out; the first has the scene
  std::uint64_t loaded_ = 1;    // of the entry that has the present scene
  bool log_fails_ = false;
  std::optional<Divergence> divergence_;
  bool divergence_due_ = false;
  bool description_due_ = false;
  bool status_due_ = false;
  bool frame_due_ = false;       // at once
  bool tick_frame_due_ = false;  // with the next tick, whichever it is
  bool interrupted_ = false;
};

}  // namespace vat
