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
  };
  /// Ends the session asynchronously. Answers waiting requests with no_such_session, and then
  /// answers `reply`, if present, with the last tick. May be called once.
  void close(End end, std::optional<PendingReply> reply);

  /// Adds a participant. The reply contains the participant and the session's description. Calls
  /// `undo` before an error reply.
  void join(PendingReply reply, std::uint64_t membership, JoinRequest request,
            std::function<void()> undo);
  /// Ends a connection. Its participant can be resumed for a limited time.
  void disconnect(PendingReply reply);
  void leave(PendingReply reply);
  /// Executes a command. The participant's role is checked at execution.
  void post(PendingReply reply, SessionCommand command);

  /// Returns the summary at the time of the last reply or turn.
  SessionSummary summary() const;

  /// Runs `task` on a frame thread, after earlier turns and the frames that these turns published.
  void post_behind(std::function<void()> task);

 private:
  using Item = SessionInbox::Item;
  /// A running control.step. Later requests of the same client wait for the end of the job.
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

  // Requests, implemented in session.cpp.
  void inbox_turn();
  void execute(Item item);
  void execute_join(PendingReply reply, const SessionInbox::Join& join);
  void execute_leave(PendingReply reply);
  void execute_disconnect(const PendingReply& reply);
  void execute_command(PendingReply reply, SessionCommand command);
  /// Answers the request, or starts the work that the result specifies.
  void answer(PendingReply reply, ActionResult result);
  /// Returns whether pointer commands wait for the next tick.
  bool tick_is_coming() const { return core_->clock().playing() || !steps_.empty(); }
  void execute_pointers();
  Steps::iterator find_step(ConnectionId client);
  void end_steps_of(ConnectionId client);
  /// Answers the job and executes its deferred requests.
  void end_step(Steps::iterator job);
  void end_all_steps();
  void close_turn();

  // Work on other threads, implemented in session_work.cpp.
  /// Starts the computation of the waiting reads on the read thread.
  void start_reads();
  void reads_done_turn();
  void export_recording(PendingReply reply);
  void save(PendingReply reply, SaveState save);

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
  SessionInbox inbox_;

  mutable std::mutex mutex_;             // guards closing_, end_ and summary_
  std::optional<PendingReply> closing_;  // answered by the last turn
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
  SessionReads reads_;
  Steps steps_;
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
