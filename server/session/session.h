#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/session/core/playback.h"
#include "server/session/core/session_core.h"
#include "server/session/pointer_commands.h"
#include "server/session/session_governor.h"
#include "server/session/session_inbox.h"
#include "server/session/session_reads.h"
#include "server/session/ticks/slow_tick_gate.h"
#include "server/session/ticks/tick_clock.h"

namespace vat {

/// A running session. Any thread can add requests to the session's inbox. A strand on the shared
/// thread pool executes the requests, runs ticks on time and sends events. A strand runs its tasks
/// one at a time. Requests of one client are executed and answered in order. See server/THREADS.md.
///
/// The strand works in short turns (some commands, or one tick). A session therefore waits for
/// another session at most one turn. The number of concurrent slow ticks is less than the number of
/// pool threads.
///
/// The session executes logged commands after the journal has stored them. Meanwhile most turns
/// wait, but no thread waits. So that ticks rarely wait, commands shortly before a tick are logged
/// after the tick.
class Session : public std::enable_shared_from_this<Session> {
 public:
  /// `playback` is null except for a replay. The pool and the gate must outlive the session.
  Session(std::unique_ptr<SessionCore> core, std::unique_ptr<Playback> playback,
          boost::asio::thread_pool& pool, SlowTickGate& slow_tick_gate);

  void start();
  /// Task for store_then(). Runs on the storage's thread.
  using StoredTask = std::function<void(Storage&, std::uint64_t session)>;
  /// Stores the session's state and then runs `task`. If the session is not stored or has diverged,
  /// answers `reply` with an error. A diverged session differs from its log.
  void store_then(StoredTask task, const std::shared_ptr<PendingReply>& reply);
  /// Reason of close().
  enum class End {
    closed,     ///< permanently closed
    resumable,  ///< recovered at the next start of the server, if stored
    moved,      ///< continued by another machine from the replica; nothing is stored
  };
  /// Ends the session asynchronously. Answers waiting requests with no_such_session, and then
  /// answers `reply`, if present, with the last tick. May be called once.
  void close(End end, std::optional<PendingReply> reply);
  /// Stores the session's state, also in the replica, ends the session as close(End::moved), and
  /// then calls `done`. close() must not be called. Must be called once.
  void hand_over(std::function<void()> done);

  /// Adds a participant. The reply contains the participant and the session's description. Calls
  /// `undo` before an error reply.
  void join(PendingReply reply, std::uint64_t membership, JoinRequest request,
            std::function<void()> undo);
  /// Ends a connection. Its participant can be resumed for a limited time.
  void disconnect(PendingReply reply);
  void leave(PendingReply reply);
  /// Executes a command. The participant's role is checked at execution.
  void post(PendingReply reply, SessionCommand command);

  /// Sends frames to a viewer who is no participant, or other frames to a known one. The viewer's
  /// connection is closed at the end of the session.
  void watch(std::shared_ptr<ClientOutbox> viewer, const Subscription& wanted);
  void unwatch(std::shared_ptr<ClientOutbox> viewer);

  /// Returns the summary at the time of the last reply or turn.
  SessionSummary summary() const;

  /// Runs `task` on a frame thread, after earlier turns, their storage work, and the frames that
  /// they published.
  void post_behind(std::function<void()> task);

 private:
  using Item = SessionInbox::Item;
  using Turn = void (Session::*)();
  /// Commands that are logged and executed together, with the replies to each.
  using Commands = std::vector<PointerCommands::Latest>;
  using Failure = std::optional<RpcError>;
  /// A running control.step. Later requests of the same client wait for the end of the job.
  struct StepJob {
    PendingReply reply;
    std::uint64_t ticks_left;
    std::deque<Item> deferred;
    std::uint64_t end_tick = 0;  // tick after the job
  };
  using Steps = std::deque<StepJob>;
  /// A running use of the storage, for which the session waits: a write to the log, or a read of
  /// saved data.
  struct StorageWait {
    std::function<void(std::optional<StorageError::Kind>)> then;
    std::optional<StorageError::Kind> failure;
    /// Keeps the pool running until the use is complete.
    boost::asio::executor_work_guard<boost::asio::thread_pool::executor_type> guard;
  };

  bool on_strand() const { return strand_.running_in_this_thread(); }
  const std::string& id() const { return core_->id(); }
  void add(Item item);
  /// Runs a turn on the strand. An exception is logged and pauses the session.
  void schedule(Turn turn);
  void run_turn(Turn turn);
  void finish_turn();
  void update_summary();
  /// Runs `task` on a frame thread, after the storage work and frames of earlier turns.
  void run_behind_storage(std::function<void()> task);

  // Requests, implemented in session.cpp. Joins and departures are in session_joins.cpp.
  void inbox_turn();
  std::optional<Item> next_item();
  /// Returns true if the item must wait for the storage or for the next tick.
  bool put_back(Item& item);
  void execute(Item item);
  void execute_stored(ParticipantNumber participant, PendingReply reply, SessionCommand command);
  void execute_join(PendingReply reply, const SessionInbox::Join& join);
  void answer_join(PendingReply& reply, ParticipantNumber number, const std::string& resume,
                   bool resumed);
  void execute_leave(PendingReply reply);
  void execute_disconnect(const PendingReply& reply);
  void execute_command(PendingReply reply, SessionCommand command);
  /// Logs and executes the commands. Then answers, and calls `then`, if present.
  void run_commands(Commands commands, std::function<void()> then = {});
  void answer_all(Commands& commands, std::vector<ActionResult>& results);
  /// Answers the request, or starts the work that the result specifies.
  void answer(PendingReply reply, const SessionCommand& command, ActionResult result);
  /// Returns whether pointer commands wait for the next tick.
  bool tick_is_coming() const { return core_->clock().playing() || !steps_.empty(); }
  /// Executes the waiting pointer commands, unless the session waits for the storage. Returns
  /// false if the caller must wait too.
  bool execute_pointers();
  void close_turn();
  void hand_over_turn();
  void drop_requests();
  void end_core();

  // Jobs of control.step, implemented in session_steps.cpp.
  StepJob* find_job(ConnectionId client);
  void end_steps_of(ConnectionId client);
  /// Ends the job. Answers the job after the reached tick is stored, and then executes its deferred
  /// requests.
  void end_step(Steps::iterator job);
  void steps_stored_turn();
  void answer_step(StepJob job, const Failure& failure);
  void end_all_steps();

  // Work on other threads, implemented in session_work.cpp.
  /// Starts the computation of the waiting reads on the read thread.
  void start_reads();
  void reads_done_turn();
  void export_recording(PendingReply reply);
  /// Runs the work on a storage thread, and answers with its result.
  void use_storage(PendingReply reply, const SessionCommand& command, StorageWork work);
  void invite(PendingReply reply, const IssueInvitation& wanted);
  /// Reads the saved data that the command names, and then calls `then`.
  void resolve_then(SessionCommand command, std::function<void(SessionCommand)> then);

  // Writes to the log, implemented in session_writes.cpp.
  /// Stores log entries and then calls `work`, with an error if the entries could not be stored. If
  /// the session is not stored, calls `work` at once.
  void log_then(std::vector<LogEntry> entries,
                std::function<void(std::span<const LogEntry>, const Failure&)> work);
  /// Calls `write` and then, after the write is complete, `then`. The session must be stored.
  void write_then(const std::function<void(SessionLog&, Journal::Done)>& write,
                  std::function<void(const Failure&)> then);
  /// Calls `start`, and calls `then` in a turn after `start`'s parameter was called.
  void wait_then(const std::function<void(Journal::Done)>& start,
                 std::function<void(std::optional<StorageError::Kind>)> then);
  /// Lets `turn` run again after the running use of the storage.
  void repeat_after_wait(Turn turn) { waiting_turns_.push_back(turn); }
  void waited_turn();
  void resume_turns();
  /// Logs and executes departures and ends of grabs that are due, and then calls `then`.
  void end_departures(const std::function<void()>& then);
  void store_settings(PendingReply reply, SessionSettings settings);
  /// Stores the participants in the replica, if there is one, and then calls `then`.
  void store_people_then(std::function<void(const Failure&)> then);
  /// Returns the time before a tick in which no write to the log should begin.
  SteadyClock::duration write_time() const;
  bool is_tick_near() const;
  /// Schedules the write of the waiting pointer commands for the tick after `now`.
  void plan_pointers(bool after_tick);
  void pointer_turn() { execute_pointers(); }
  void end_hold();
  bool uses_storage() const { return wait_.has_value() || !ending_steps_.empty(); }
  /// Sends the event session.storage.
  void tell_storage();

  // Ticks and timers, implemented in session_ticks.cpp.
  void schedule_step();
  void step_turn();
  void tick_turn();
  void run_tick(SteadyClock::time_point now, bool timed);
  /// Runs ticks that waited for a place of the slow-tick gate.
  void place_turn();
  /// Returns whether a tick may run now. If not, place_turn() runs the tick later.
  bool has_place();
  void begin_seek(PendingReply reply, std::uint64_t position);
  void seek_turn();
  void end_seek();
  void follow_clock();
  void wait_for_tick();
  void status_turn();
  void upkeep_turn();
  void wait_for_status();
  void note_emptiness(SteadyClock::time_point now);
  /// Sends changed presence data. Waits if presence data was sent shortly before.
  void follow_presence();
  void presence_turn() {}  // finish_turn() sends the presence data
  /// Stores the session's progress if storing is due.
  void store_progress();
  void end_log(End end);

  Clock& clock_;
  boost::asio::strand<boost::asio::thread_pool::executor_type> strand_;
  boost::asio::strand<boost::asio::thread_pool::executor_type> storage_strand_;
  SessionInbox inbox_;

  mutable std::mutex mutex_;             // guards closing_, end_ and summary_
  std::optional<PendingReply> closing_;  // answered by the last turn
  std::function<void()> handed_over_;    // called after hand_over()
  End end_ = End::resumable;
  SessionSummary summary_;

  // Members that only the strand uses.
  const std::unique_ptr<SessionCore> core_;
  std::unique_ptr<Playback> playback_;
  TickClock ticks_;
  std::optional<SteadyClock::time_point> empty_since_;
  bool hibernating_ = false;
  SteadyClock::duration period_{};  // period of the tick timer; zero: timer is off
  const std::unique_ptr<Timer> tick_timer_;
  const std::unique_ptr<Timer> status_timer_;
  const std::unique_ptr<Timer> presence_timer_;
  bool presence_waits_ = false;
  PointerCommands pointers_;
  const std::unique_ptr<Timer> pointer_timer_;
  bool pointers_skip_tick_ = false;  // the pointer commands came too late for the next tick
  SessionGovernor governor_;
  SessionReads reads_;
  Steps steps_;
  Steps ending_steps_;  // jobs whose reached tick is being stored
  std::deque<std::optional<StorageError::Kind>> stored_steps_;  // results for the first of them
  std::deque<Item> put_back_;  // requests before those of the inbox
  bool holds_inbox_ = false;   // the inbox waits for the next tick
  bool has_held_inbox_ = false;
  std::optional<StorageWait> wait_;
  std::vector<Turn> waiting_turns_;  // wait for wait_
  std::vector<std::function<void()>> tasks_behind_storage_;
  bool step_scheduled_ = false;
  SlowTickGate& slow_tick_gate_;
  bool is_slow_ = false;  // whether the last tick was slow
  bool waits_for_place_ = false;
  SlowTickGate::Place place_;                      // set during a turn only
  std::optional<std::vector<PendingReply>> seek_;  // replies of a running replay.seek
  bool seek_scheduled_ = false;
  bool closed_ = false;
};

}  // namespace vat
