#pragma once

#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/session/core/playback.h"
#include "server/session/core/session_core.h"
#include "server/session/pointer_commands.h"
#include "server/session/session_inbox.h"
#include "server/session/ticks/slow_tick_gate.h"
#include "server/session/ticks/tick_clock.h"

namespace vat {

/// A running session: an inbox for requests from any thread, and a strand on the shared pool that
/// executes them, runs ticks in time and sends events. Requests of one client are executed and
/// answered in their order. See server/THREADS.md.
///
/// The strand works in short turns (some commands, or one tick), so that sessions wait for each
/// other at most one turn. Slow ticks have fewer places than the pool has threads.
class Session : public std::enable_shared_from_this<Session> {
 public:
  /// `playback` is null except for a replay. The pool and the gate must outlive this.
  Session(std::unique_ptr<SessionCore> core, std::unique_ptr<Playback> playback,
          boost::asio::thread_pool& pool, SlowTickGate& slow_tick_gate);

  void start();
  /// Stores the session's state and then runs `task` on the storage's thread. If the session is
  /// not stored, or diverged, answers `reply` with an error.
  using StoredTask = std::function<void(Storage&, std::uint64_t session)>;
  void store_then(StoredTask task, const std::shared_ptr<PendingReply>& reply);
  /// Ends all work soon. Requests that are not executed yet are answered by no_such_session, and
  /// then `reply`, if present, by the last tick. May be called once.
  enum class End {
    closed,     ///< for good
    resumable,  ///< a stored session is recovered when the server starts again
  };
  void close(End end, std::optional<PendingReply> reply);

  /// Answered with the participant and the session's description. Calls `undo` before a refusal.
  void join(PendingReply reply, std::uint64_t membership, JoinRequest request,
            std::function<void()> undo);
  /// The connection has ended. Its participant can be resumed for a limited time.
  void disconnect(PendingReply reply);
  void leave(PendingReply reply);
  /// The participant's role is checked when the command is executed.
  void post(PendingReply reply, SessionCommand command);

  /// As of the last answer or turn.
  SessionSummary summary() const;

  /// Runs `task` on a frame thread, after the turns posted before and the frames they published.
  void post_behind(std::function<void()> task);

 private:
  using Item = SessionInbox::Item;
  /// A control.step that runs. Later requests of its client wait for its end.
  struct StepJob {
    PendingReply reply;
    std::uint64_t ticks_left;
    std::deque<Item> deferred;
  };
  using Steps = std::deque<StepJob>;

  bool on_strand() const { return strand_.running_in_this_thread(); }
  const std::string& id() const { return core_->id(); }
  void add(Item item);
  /// Runs a turn on the strand. An exception is logged and pauses the session.
  void schedule(void (Session::*turn)());
  void run_turn(void (Session::*turn)());
  void finish_turn();
  void update_summary();

  // Requests: session.cpp.
  void inbox_turn();
  void execute(Item item);
  void execute_join(PendingReply reply, const SessionInbox::Join& join);
  void execute_leave(PendingReply reply);
  void execute_disconnect(const PendingReply& reply);
  void execute_command(PendingReply reply, SessionCommand command);
  /// Answers, or starts the work that the result asks for.
  void answer(PendingReply reply, ActionResult result);
  void export_recording(PendingReply reply);
  void save(PendingReply reply, SaveState save);
  /// Whether commands that follow a pointer wait for the next tick.
  bool tick_is_coming() const { return core_->clock().playing() || !steps_.empty(); }
  void execute_pointers();
  Steps::iterator find_step(ConnectionId client);
  void end_steps_of(ConnectionId client);
  /// Answers the job and executes its deferred requests.
  void end_step(Steps::iterator job);
  void end_all_steps();
  void close_turn();

  // Ticks and timers: session_ticks.cpp.
  void schedule_step();
  void step_turn();
  void tick_turn();
  void run_tick(SteadyClock::time_point now, bool timed);
  /// Ticks that waited for a place among the slow ones.
  void place_turn();
  /// Returns whether a tick may run now. If not, place_turn() runs it later.
  bool has_place();
  void begin_seek(PendingReply reply, std::uint64_t position);
  void seek_turn();
  void end_seek();
  void follow_clock();
  void wait_for_tick();
  void status_turn();
  void wait_for_status();
  void note_emptiness(SteadyClock::time_point now);
  /// Sends changed presence now or, if the last was sent shortly before, later.
  void follow_presence();
  void presence_turn() {}  // finish_turn() sends it
  /// Stores the session's progress from time to time.
  void store_progress();
  void end_log(End end);

  Clock& clock_;
  boost::asio::strand<boost::asio::thread_pool::executor_type> strand_;
  SessionInbox inbox_;

  mutable std::mutex mutex_;             // guards the next three
  std::optional<PendingReply> closing_;  // answered by the last turn
  End end_ = End::resumable;
  SessionSummary summary_;

  // Used on the strand only.
  const std::unique_ptr<SessionCore> core_;
  std::unique_ptr<Playback> playback_;
  TickClock ticks_;
  std::optional<SteadyClock::time_point> empty_since_;
  bool hibernating_ = false;
  SteadyClock::duration period_{};  // of the tick timer; zero: it is off
  const std::unique_ptr<Timer> tick_timer_;
  const std::unique_ptr<Timer> status_timer_;
  const std::unique_ptr<Timer> presence_timer_;
  bool presence_waits_ = false;
  PointerCommands pointers_;
  Steps steps_;
  bool step_scheduled_ = false;
  SlowTickGate& slow_tick_gate_;
  bool is_slow_ = false;  // the last tick was
  bool waits_for_place_ = false;
  SlowTickGate::Place place_;                      // during a turn only
  std::optional<std::vector<PendingReply>> seek_;  // replies of a replay.seek that runs
  bool seek_scheduled_ = false;
  bool closed_ = false;
};

}  // namespace vat
