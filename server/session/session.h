#pragma once

#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "server/session/pending_reply.h"
#include "server/session/pointer_commands.h"
#include "server/session/replay_run.h"
#include "server/session/session_core.h"
#include "server/session/session_recovery.h"
#include "server/session/slow_tick_gate.h"

namespace vat {

/// A session at work: an inbox that any thread may post to, and a strand on the shared pool where
/// commands are applied, ticks are run in time, and statuses are sent. Everything posted by one
/// client is carried out and answered in its order.
///
/// The strand's work comes in short turns (some commands, or one tick), so that a session waits for
/// others at most as long as their turns take; and for no long tick, as these have fewer places
/// than the pool has threads.
///
/// Locks are taken in this order, and none is held while a scene is read, stepped or encoded: the
/// directory's (who is where), a session's (its inbox and summary), a client's outbox or a
/// session's frame feed, and that of the connection. So commands reach the inbox in the order of
/// joins and leaves, and what a client has left cannot write to it. Turns take the later ones only;
/// all else of a session is used on its strand alone.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(std::string id, SessionSettings settings, Simulation simulation, ResourceShare share,
          const SessionEnvironment& environment, boost::asio::thread_pool& pool,
          SlowTickGate& slow_tick_gate);

  /// Before start(): it is kept from now on.
  void keep_in(std::unique_ptr<SessionLog> log) { core_.keep_in(std::move(log)); }
  /// Before start(), in place of that: makes it what it was, and keeps it. It must have been made
  /// with what the recovery began with.
  void recover(SessionRecovery& recovery, Storage& storage, const SessionEnvironment& environment);
  /// Before start(), in place of both: it shows a recording.
  void show(std::unique_ptr<ReplayRun> replay);
  void start();
  /// Writes down where it is; what is kept is then for `task`, on the storage's thread. Where it is
  /// kept nowhere, or not any more, `caller` is told.
  using KeptTask = std::function<void(Storage&, std::uint64_t session)>;
  void keep_and(KeptTask task, const std::shared_ptr<PendingReply>& caller);
  /// Ends all work soon, at most once: commands that are not carried out yet are answered by
  /// no_such_session, and then the caller, if there is one, with the tick that was the last. Where
  /// it is kept, it may come back from where it was.
  enum class End { closed, may_come_back };
  void close(End end, std::optional<PendingReply> caller);

  /// Answered with who it is then, and the description.
  /// Where it is refused, `undo` is called first.
  void join(PendingReply caller, std::uint64_t membership, JoinRequest join_request,
            std::function<void()> undo);
  /// The caller's connection has ended; its participant may be resumed for a while.
  void disconnect(PendingReply caller);
  void leave(PendingReply caller);
  /// The participant's role has to be as the command's rules ask when its turn comes.
  void post(PendingReply caller, SessionCommand command);

  /// As of the last answer or turn.
  SessionSummary summary() const;

  /// Runs `task` on a frame thread, after the turns posted before and the frames they published.
  void post_behind(std::function<void()> task);

 private:
  struct Join {
    std::uint64_t membership;
    JoinRequest join_request;
    std::function<void()> undo;
  };
  struct Leave {};
  struct Disconnect {};
  struct Item {
    PendingReply caller;
    std::variant<Join, Leave, Disconnect, SessionCommand> task;
  };
  /// A control.step under way. The later commands of its client wait for its end.
  struct StepJob {
    PendingReply caller;
    std::uint64_t ticks_left;
    std::deque<Item> deferred;
  };

  /// A replay.seek under way: whoever asks for another place meanwhile is answered there too.
  struct Seek {
    std::vector<PendingReply> callers;
  };

  void put(Item item);
  /// Runs a turn on the strand; what it throws is logged, and pauses the session.
  void schedule(void (Session::*turn)());
  void run_turn(void (Session::*turn)());
  void end_turn();
  void update_summary();

  void inbox_turn();
  bool take_item(std::optional<Item>& item);
  void carry_out(Item item);
  void carry_out_join(PendingReply caller, const Join& join);
  void carry_out_leave(PendingReply caller);
  void carry_out_disconnect(const PendingReply& caller);
  void end_steps_of(ConnectionId client);
  void carry_out_command(PendingReply caller, SessionCommand command);
  void answer(PendingReply caller, ActionResult result);
  /// Whether a tick is to come, before which commands that follow a pointer wait.
  bool tick_is_coming() const;
  /// Carries out those that have waited.
  void carry_out_pointers();

  void step_turn();
  /// The ticks that waited for a place.
  void place_turn();
  /// Whether a tick may run now: at once, unless the last one took long and others have the places
  /// for such. Then it comes back by place_turn().
  bool has_place();
  std::deque<StepJob>::iterator find_step(ConnectionId client);
  /// Makes a recording of what is kept, and answers where it is.
  void record(PendingReply caller);
  /// Keeps the present state under a name, and answers then.
  void save(PendingReply caller, SaveState save);
  void schedule_step();
  void begin_seek(PendingReply caller, std::uint64_t position);
  void seek_turn();
  void end_seek();
  /// Answers the job and carries out what was deferred.
  void end_step(std::deque<StepJob>::iterator job);
  void end_all_steps();

  void tick_turn();
  void run_tick(SteadyClock::time_point now, bool timed);
  void note_emptiness(SteadyClock::time_point now);
  void follow_clock();
  void wait_for_tick();
  void status_turn();
  void wait_for_status();
  /// Notes where it is, from time to time.
  void keep_moment();
  void end_log(End end);
  /// Tells of changes at once or, where others were told just before, later.
  void follow_presence();
  void presence_turn() {}  // what is due is told at the end of every turn
  void close_turn();

  const std::string id_;
  Clock& clock_;
  boost::asio::strand<boost::asio::thread_pool::executor_type> strand_;

  mutable std::mutex mutex_;  // guards what follows, as far as the summary
  std::deque<Item> inbox_;
  bool inbox_scheduled_ = false;
  bool inbox_closed_ = false;
  std::optional<PendingReply> closer_;  // is answered by the last turn
  End end_ = End::may_come_back;
  SessionSummary summary_;

  // Used on the strand only.
  SessionCore core_;
  TickClock ticks_;
  std::optional<SteadyClock::time_point> empty_since_;
  bool hibernating_ = false;
  SteadyClock::duration period_{};  // of the clock; zero: it stands still
  const std::unique_ptr<Timer> tick_timer_;
  const std::unique_ptr<Timer> status_timer_;
  const std::unique_ptr<Timer> presence_timer_;
  bool presence_waits_ = false;
  PointerCommands pointers_;
  std::deque<StepJob> steps_;
  bool step_scheduled_ = false;
  SlowTickGate& slow_tick_gate_;
  bool is_long_ = false;  // the last tick was
  bool waits_for_place_ = false;
  SlowTickGate::Place place_;          // during a turn only
  std::unique_ptr<ReplayRun> replay_;  // null: what is simulated is new
  std::optional<Seek> seek_;
  bool seek_scheduled_ = false;
  bool closed_ = false;
};

}  // namespace vat
