// Life of a session, and execution of its requests.

#include "server/session/session.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <chrono>
#include <exception>
#include <utility>

#include "core/support/check.h"
#include "server/session/core/command_entry.h"
#include "server/support/log.h"

namespace vat {
namespace {

// A turn of the inbox ends after these, so that ticks and other sessions get their turns.
constexpr std::size_t kCommandsPerTurn = 64;
constexpr auto kTurnTime = std::chrono::milliseconds(10);

}  // namespace

Session::Session(std::unique_ptr<SessionCore> core, std::unique_ptr<Playback> playback,
                 boost::asio::thread_pool& pool, SlowTickGate& slow_tick_gate)
    : clock_(core->environment().clock),
      strand_(boost::asio::make_strand(pool.get_executor())),
      storage_strand_(boost::asio::make_strand((core->environment().storage_threads != nullptr
                                                    ? *core->environment().storage_threads
                                                    : pool)
                                                   .get_executor())),
      core_(std::move(core)),
      playback_(std::move(playback)),
      tick_timer_(clock_.make_timer(strand_)),
      status_timer_(clock_.make_timer(strand_)),
      presence_timer_(clock_.make_timer(strand_)),
      pointer_timer_(clock_.make_timer(strand_)),
      reads_(core_->environment()),
      slow_tick_gate_(slow_tick_gate) {
  VAT_CHECK(core_->playback() == playback_.get());
  update_summary();
}

void Session::start() {
  schedule(&Session::status_turn);
}

void Session::close(End end, std::optional<PendingReply> reply) {
  {
    const std::lock_guard lock(mutex_);
    end_ = end;
    closing_ = std::move(reply);
  }
  schedule(&Session::close_turn);
}

void Session::hand_over(std::function<void()> done) {
  {
    const std::lock_guard lock(mutex_);
    end_ = End::moved;
    handed_over_ = std::move(done);
  }
  schedule(&Session::hand_over_turn);
}

void Session::hand_over_turn() {
  std::function<void()> done;
  {
    const std::lock_guard lock(mutex_);
    done.swap(handed_over_);
  }
  SessionLog* const log = core_->history().log();
  if (log == nullptr || core_->history().divergence()) {
    close_turn();
    return done();
  }
  log->store_all(core_->history().moment(), clock_.now(), std::move(done));
  close_turn();
}

void Session::join(PendingReply reply, std::uint64_t membership, JoinRequest request,
                   std::function<void()> undo) {
  add({std::move(reply), SessionInbox::Join{membership, std::move(request), std::move(undo)}});
}

void Session::disconnect(PendingReply reply) {
  add({std::move(reply), SessionInbox::Disconnect{}});
}

void Session::leave(PendingReply reply) {
  add({std::move(reply), SessionInbox::Leave{}});
}

void Session::post(PendingReply reply, SessionCommand command) {
  VAT_CHECK(command.row != nullptr && command.action != nullptr);
  add({std::move(reply), std::move(command)});
}

SessionSummary Session::summary() const {
  const std::lock_guard lock(mutex_);
  return summary_;
}

void Session::add(Item item) {
  switch (inbox_.add(item)) {
    case SessionInbox::Added::to_pending:
      return;
    case SessionInbox::Added::first:
      return schedule(&Session::inbox_turn);
    case SessionInbox::Added::refused: {
      const std::lock_guard lock(mutex_);
      if (end_ != End::moved) item.reply.answer(no_such_session(id()));
      return;
    }
  }
}

void Session::schedule(Turn turn) {
  boost::asio::post(strand_, [self = shared_from_this(), turn] { self->run_turn(turn); });
}

void Session::run_turn(Turn turn) {
  VAT_CHECK(on_strand());
  if (closed_) return;
  const bool may_run = turn == &Session::waited_turn || turn == &Session::reads_done_turn ||
                       turn == &Session::presence_turn;
  if (wait_ && !may_run) return repeat_after_wait(turn);
  const ThreadOwner::Hold hold(core_->owner());
  const ThreadPoolRunner::HelperReservation reservation(core_->environment().runner);
  try {
    (this->*turn)();
    finish_turn();
  } catch (const std::exception& error) {
    log_error("session {}: paused by a fault of the server: {}", id(), error.what());
    core_->set_playing(false);
    period_ = {};
    tick_timer_->cancel();
    end_hold();
  }
  place_.reset();
  if (uses_storage()) return;
  for (const Turn waiting : std::exchange(waiting_turns_, {})) schedule(waiting);  // after a fault
  for (auto& task : std::exchange(tasks_behind_storage_, {})) {
    run_behind_storage(std::move(task));
  }
}

void Session::finish_turn() {
  if (closed_) return;
  if (core_->clock().take_interruption()) end_all_steps();
  if (!tick_is_coming()) execute_pointers();
  if (core_->history().take_failing_change()) tell_storage();
  if (!seek_) core_->notifier().announce();
  if (playback_ && !seek_) playback_->tell_people(*core_, clock_.now());
  follow_presence();
  note_emptiness(clock_.now());
  follow_clock();
  if (period_ == SteadyClock::duration::zero()) end_hold();
  update_summary();
  store_progress();
}

void Session::update_summary() {
  SessionSummary summary = core_->notifier().summary();
  summary.hibernating = hibernating_ && summary.playing;
  summary.empty_since = empty_since_;
  const std::lock_guard lock(mutex_);
  summary_ = std::move(summary);
}

void Session::inbox_turn() {
  core_->notifier().presence().touch();
  const auto end = CostClock::now() + kTurnTime;
  for (std::size_t i = 0; i < kCommandsPerTurn && CostClock::now() < end; ++i) {
    std::optional<Item> item = next_item();
    if (!item || put_back(*item)) return;
    try {
      execute(*std::move(item));
    } catch (...) {
      schedule(&Session::inbox_turn);  // for the requests that are left
      throw;
    }
    if (wait_) return repeat_after_wait(&Session::inbox_turn);
  }
  schedule(&Session::inbox_turn);
}

std::optional<SessionInbox::Item> Session::next_item() {
  if (put_back_.empty()) return inbox_.take();
  std::optional<Item> item(std::move(put_back_.front()));
  put_back_.pop_front();
  return item;
}

bool Session::put_back(Item& item) {
  const auto* command = std::get_if<SessionCommand>(&item.task);
  if (command == nullptr) {
    // The connection may have been another participant's.
    if (execute_pointers()) return false;
    repeat_after_wait(&Session::inbox_turn);
  } else {
    const bool is_logged = core_->history().log() != nullptr && command->row->is_logged() &&
                           command->row->rate_class != RateClass::pointer;
    if (!is_logged || has_held_inbox_ || !is_tick_near()) return false;
    holds_inbox_ = true;  // the next tick continues the inbox
  }
  put_back_.push_front(std::move(item));
  return true;
}

void Session::execute(Item item) {
  const bool is_leave = std::holds_alternative<SessionInbox::Leave>(item.task);
  const bool is_disconnect = std::holds_alternative<SessionInbox::Disconnect>(item.task);
  const ConnectionId client = item.reply.client()->id();
  if (StepJob* const job = find_job(client)) {
    job->deferred.push_back(std::move(item));
    if (is_leave || is_disconnect) end_steps_of(client);
  } else if (is_leave) {
    execute_leave(std::move(item.reply));
  } else if (is_disconnect) {
    execute_disconnect(item.reply);
  } else if (const auto* watch = std::get_if<SessionInbox::Watch>(&item.task)) {
    core_->notifier().watch(item.reply.client(), watch->wanted, clock_.now());
  } else if (std::holds_alternative<SessionInbox::Unwatch>(item.task)) {
    core_->notifier().unwatch(client);
  } else if (const auto* join = std::get_if<SessionInbox::Join>(&item.task)) {
    execute_join(std::move(item.reply), *join);
  } else {
    execute_command(std::move(item.reply), std::get<SessionCommand>(std::move(item.task)));
  }
}

void Session::execute_command(PendingReply reply, SessionCommand command) {
  const Participant* participant = core_->participants().find_client(reply.client()->id());
  if (participant == nullptr) {
    reply.answer(not_joined());
    return;
  }
  const MethodRow& row = *command.row;
  if (auto error = refuse_role(row, participant->role)) {
    reply.answer(*std::move(error));
    return;
  }
  if (playback_ && row.changes_scene()) {
    reply.answer(not_allowed("the session is a replay and cannot be changed"));
    return;
  }
  if (row.is_logged() && row.rate_class == RateClass::pointer) {
    const bool is_first = pointers_.empty();
    pointers_.add(participant->number, std::move(command), std::move(reply));
    if (is_first) plan_pointers(false);
    return;
  }
  if (!names_saved_data(core_->environment(), command)) {
    return execute_stored(participant->number, std::move(reply), std::move(command));
  }
  resolve_then(std::move(command), [this, number = participant->number,
                                    waiting = std::make_shared<PendingReply>(std::move(reply))](
                                       SessionCommand resolved) {
    execute_stored(number, std::move(*waiting), std::move(resolved));
  });
}

void Session::execute_stored(ParticipantNumber participant, PendingReply reply,
                             SessionCommand command) {
  const MethodRow& row = *command.row;
  // Keeps the order: of commands of the session, and of all requests of this client.
  const bool is_ordered = row.is_logged() || row.rate_class == RateClass::control;
  Commands commands;
  if (is_ordered || pointers_.has_of(participant)) commands = pointers_.take();
  commands.push_back({participant, std::move(command), {}});
  commands.back().replies.push_back(std::move(reply));
  run_commands(std::move(commands));
}

void Session::run_commands(Commands commands, std::function<void()> then) {
  struct Running {
    Commands commands;
    CommandBatch batch;
    std::vector<ActionResult> results;
  };
  const auto running = std::make_shared<Running>(Running{std::move(commands), {}, {}});
  std::vector<ParticipantCommand> of_participants;
  for (const auto& one : running->commands) {
    of_participants.push_back({one.participant, one.command});
  }
  running->batch = core_->prepare(of_participants);
  auto entries = std::exchange(running->batch.entries, {});
  log_then(std::move(entries), [this, running, then = std::move(then)](
                                   std::span<const LogEntry> stored, const Failure& failure) {
    const auto begin = CostClock::now();
    running->results = core_->execute(running->batch, stored, failure);
    if (SessionLog* const log = core_->history().log()) log->add_work(CostClock::now() - begin);
    end_departures([this, running, then] {
      answer_all(running->commands, running->results);
      if (then) then();
    });
  });
}

void Session::answer_all(Commands& commands, std::vector<ActionResult>& results) {
  VAT_CHECK(results.size() == commands.size());
  if (core_->clock().take_interruption()) end_all_steps();
  update_summary();
  for (std::size_t i = 0; i < commands.size(); ++i) {
    for (PendingReply& reply : commands[i].replies) {
      answer(std::move(reply), commands[i].command, results[i]);
    }
  }
}

void Session::answer(PendingReply reply, const SessionCommand& command, ActionResult result) {
  if (const auto* run = std::get_if<RunTicks>(&result)) {
    VAT_CHECK(run->count > 0);
    steps_.push_back({std::move(reply), run->count, {}, 0});
    schedule_step();
  } else if (std::holds_alternative<MakeRecording>(result)) {
    export_recording(std::move(reply));
  } else if (const auto* seek = std::get_if<SeekTo>(&result)) {
    begin_seek(std::move(reply), seek->position);
  } else if (auto* work = std::get_if<StorageWork>(&result)) {
    use_storage(std::move(reply), command, std::move(*work));
  } else if (const auto* invitation = std::get_if<IssueInvitation>(&result)) {
    invite(std::move(reply), *invitation);
  } else if (auto* settings = std::get_if<StoreSettings>(&result)) {
    store_settings(std::move(reply), std::move(settings->settings));
  } else if (auto* read = std::get_if<Read>(&result)) {
    std::string key = std::string(command.row->name) + command.params.dump() + read->copied;
    reads_.add({std::move(reply), std::move(*read), std::move(key)});
    start_reads();
  } else if (auto* error = std::get_if<RpcError>(&result)) {
    reply.answer(std::move(*error));
  } else {
    Json& content = std::get<Json>(result);
    content["tick"] = core_->run().tick();
    reply.answer(std::move(content));
  }
}

bool Session::execute_pointers() {
  VAT_CHECK(on_strand());
  if (!wait_ && !pointers_.empty()) run_commands(pointers_.take());
  return !wait_;
}

void Session::close_turn() {
  VAT_CHECK(on_strand() && !closed_);
  closed_ = true;
  tick_timer_->cancel();
  status_timer_->cancel();
  presence_timer_->cancel();
  pointer_timer_->cancel();
  std::deque<Item> items = inbox_.close();
  std::optional<PendingReply> closing;
  End end = End::resumable;
  {
    const std::lock_guard lock(mutex_);
    end = end_;
    closing.swap(closing_);
  }
  end_log(end);
  if (end == End::moved) return drop_requests();
  const RpcError error = no_such_session(id());
  if (seek_) {
    for (PendingReply& reply : *seek_) reply.answer(error);
  }
  for (Steps* const steps : {&ending_steps_, &steps_}) {
    for (StepJob& job : *steps) {
      job.reply.answer(error);
      for (Item& item : job.deferred) item.reply.answer(error);
    }
    steps->clear();
  }
  for (Item& item : std::exchange(put_back_, {})) item.reply.answer(error);
  for (auto& latest : pointers_.take()) {
    for (PendingReply& reply : latest.replies) reply.answer(error);
  }
  for (Item& item : items) item.reply.answer(error);
  reads_.refuse_all(error);
  end_core();
  if (closing) closing->answer(Json{{"tick", core_->run().tick()}});
}

// The event session.moved ends the requests of the session's clients, without replies.
void Session::drop_requests() {
  ending_steps_.clear();
  steps_.clear();
  put_back_.clear();
  pointers_.take();
  end_core();
}

void Session::end_core() {
  core_->notifier().end_watchers();
  core_->set_playback(nullptr);
  playback_.reset();
  core_->run().end();
}

}  // namespace vat
