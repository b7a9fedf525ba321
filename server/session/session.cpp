// Life of a session, and execution of its requests.

#include "server/session/session.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <chrono>
#include <exception>
#include <utility>

#include "core/support/check.h"

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
      core_(std::move(core)),
      playback_(std::move(playback)),
      tick_timer_(clock_.make_timer(strand_)),
      status_timer_(clock_.make_timer(strand_)),
      presence_timer_(clock_.make_timer(strand_)),
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

void Session::post_behind(std::function<void()> task) {
  boost::asio::post(strand_, [self = shared_from_this(), task = std::move(task)]() mutable {
    self->core_->notifier().post_behind_frames(std::move(task));
  });
}

void Session::store_then(StoredTask task, const std::shared_ptr<PendingReply>& reply) {
  boost::asio::post(strand_, [self = shared_from_this(), task = std::move(task), reply] {
    SessionHistory& history = self->core_->history();
    SessionLog* const log = self->closed_ ? nullptr : history.log();
    if (log == nullptr) {
      reply->answer(no_such_session(self->id()));
    } else if (history.divergence()) {
      reply->answer(not_allowed("the session differs from its log"));
    } else {
      log->store_then(history.moment(), self->clock_.now(), task);
    }
  });
}

void Session::add(Item item) {
  switch (inbox_.add(item)) {
    case SessionInbox::Added::to_pending:
      return;
    case SessionInbox::Added::first:
      return schedule(&Session::inbox_turn);
    case SessionInbox::Added::refused:
      return item.reply.answer(no_such_session(id()));
  }
}

void Session::schedule(void (Session::*turn)()) {
  boost::asio::post(strand_, [self = shared_from_this(), turn] { self->run_turn(turn); });
}

void Session::run_turn(void (Session::*turn)()) {
  VAT_CHECK(on_strand());
  if (closed_) return;
  const ThreadOwner::Hold hold(core_->owner());
  const ThreadPoolRunner::HelperReservation reservation(core_->environment().runner);
  try {
    (this->*turn)();
    finish_turn();
  } catch (const std::exception& error) {
    spdlog::error("session {}: paused by a fault of the server: {}", id(), error.what());
    core_->set_playing(false);
    period_ = {};
    tick_timer_->cancel();
  }
  place_.reset();
}

void Session::finish_turn() {
  if (closed_) return;
  if (core_->clock().take_interruption()) end_all_steps();
  if (!tick_is_coming()) execute_pointers();
  if (!seek_) core_->notifier().announce();
  if (playback_ && !seek_) playback_->tell_people(*core_, clock_.now());
  follow_presence();
  note_emptiness(clock_.now());
  follow_clock();
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
    std::optional<Item> item = inbox_.take();
    if (!item) return;
    try {
      execute(*std::move(item));
    } catch (...) {
      schedule(&Session::inbox_turn);  // for the requests that are left
      throw;
    }
  }
  schedule(&Session::inbox_turn);
}

void Session::execute(Item item) {
  if (std::holds_alternative<SessionInbox::Leave>(item.task)) {
    execute_leave(std::move(item.reply));
    return;
  }
  if (std::holds_alternative<SessionInbox::Disconnect>(item.task)) {
    execute_disconnect(item.reply);
    return;
  }
  if (const auto job = find_step(item.reply.client()->id()); job != steps_.end()) {
    job->deferred.push_back(std::move(item));
  } else if (const auto* join = std::get_if<SessionInbox::Join>(&item.task)) {
    execute_join(std::move(item.reply), *join);
  } else {
    execute_command(std::move(item.reply), std::get<SessionCommand>(std::move(item.task)));
  }
}

void Session::execute_join(PendingReply reply, const SessionInbox::Join& join) {
  execute_pointers();  // the connection may have been another participant's
  auto joined = core_->people().join(reply.client(), join.membership, join.request, clock_.now());
  if (auto* error = std::get_if<RpcError>(&joined)) {
    join.undo();
    reply.answer(std::move(*error));
    return;
  }
  const auto& [participant, resume, resumed] = std::get<JoinedParticipant>(joined);
  update_summary();  // before the answer, as below: lists then show what was done
  const Json content{{"tick", core_->run().tick()},
                     {"session", id()},
                     {"participant", participant.number},
                     {"name", participant.name},
                     {"role", to_string(participant.role)},
                     {"resume", resume},
                     {"resumed", resumed},
                     {"settings", core_->people().describe_settings()},
                     {"participants", describe_participants(core_->participants())}};
  const auto description = core_->notifier().description();
  reply.answer_text(begin_object(content, "description") + description.begin, description.end);
}

void Session::execute_leave(PendingReply reply) {
  const ConnectionId client = reply.client()->id();
  execute_pointers();
  end_steps_of(client);
  if (const Participant* participant = core_->participants().find_client(client)) {
    core_->people().leave(participant->number);
  }
  update_summary();
  reply.answer(Json{{"tick", core_->run().tick()}});
}

void Session::execute_disconnect(const PendingReply& reply) {
  execute_pointers();
  end_steps_of(reply.client()->id());
  core_->people().disconnect(reply.client()->id(), clock_.now());
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
    pointers_.add(participant->number, std::move(command), std::move(reply));
    return;
  }
  // Keeps the order: of commands of the session, and of all requests of this client.
  const bool is_ordered = row.is_logged() || row.rate_class == RateClass::control;
  if (is_ordered || pointers_.has_of(participant->number)) execute_pointers();
  const ParticipantCommand by_participant{participant->number, command};
  const auto begin = CostClock::now();
  ActionResult result = std::move(core_->execute({&by_participant, 1}).front());
  if (SessionLog* const log = core_->history().log()) log->add_work(CostClock::now() - begin);
  if (core_->clock().take_interruption()) end_all_steps();
  update_summary();
  if (auto* read = std::get_if<Read>(&result)) {
    std::string key = std::string(row.name) + command.params.dump() + read->copied;
    reads_.add({std::move(reply), std::move(*read), std::move(key)});
    return start_reads();
  }
  answer(std::move(reply), std::move(result));
}

void Session::answer(PendingReply reply, ActionResult result) {
  if (const auto* run = std::get_if<RunTicks>(&result)) {
    VAT_CHECK(run->count > 0);
    steps_.push_back({std::move(reply), run->count, {}});
    schedule_step();
  } else if (std::holds_alternative<MakeRecording>(result)) {
    export_recording(std::move(reply));
  } else if (const auto* seek = std::get_if<SeekTo>(&result)) {
    begin_seek(std::move(reply), seek->position);
  } else if (auto* wanted = std::get_if<SaveState>(&result)) {
    save(std::move(reply), std::move(*wanted));
  } else if (auto* error = std::get_if<RpcError>(&result)) {
    reply.answer(std::move(*error));
  } else {
    Json& content = std::get<Json>(result);
    content["tick"] = core_->run().tick();
    reply.answer(std::move(content));
  }
}

void Session::execute_pointers() {
  if (pointers_.empty()) return;
  VAT_CHECK(on_strand());
  std::vector<PointerCommands::Latest> waiting = pointers_.take();
  std::vector<ParticipantCommand> commands;
  commands.reserve(waiting.size());
  for (const auto& latest : waiting) commands.push_back({latest.participant, latest.command});
  const std::vector<ActionResult> results = core_->execute(commands);
  VAT_CHECK(results.size() == waiting.size());
  for (std::size_t i = 0; i < waiting.size(); ++i) {
    for (PendingReply& reply : waiting[i].replies) answer(std::move(reply), results[i]);
  }
}

Session::Steps::iterator Session::find_step(ConnectionId client) {
  return std::ranges::find_if(
      steps_, [&](const StepJob& job) { return job.reply.client()->id() == client; });
}

void Session::end_steps_of(ConnectionId client) {
  for (auto job = find_step(client); job != steps_.end(); job = find_step(client)) end_step(job);
}

void Session::end_step(Steps::iterator job) {
  VAT_CHECK(job != steps_.end());
  StepJob ended = std::move(*job);
  steps_.erase(job);
  update_summary();
  if (auto error = core_->history().reach()) {
    ended.reply.answer(*std::move(error));
  } else {
    ended.reply.answer(Json{{"tick", core_->run().tick()}});
  }
  for (Item& item : ended.deferred) execute(std::move(item));
}

void Session::end_all_steps() {
  // Deferred requests may start new steps, which stay.
  for (std::size_t count = steps_.size(); count > 0 && !steps_.empty(); --count) {
    end_step(steps_.begin());
  }
}

void Session::close_turn() {
  VAT_CHECK(on_strand() && !closed_);
  closed_ = true;
  tick_timer_->cancel();
  status_timer_->cancel();
  presence_timer_->cancel();
  std::deque<Item> items = inbox_.close();
  std::optional<PendingReply> closing;
  End end = End::resumable;
  {
    const std::lock_guard lock(mutex_);
    end = end_;
    closing.swap(closing_);
  }
  end_log(end);
  const RpcError error = no_such_session(id());
  if (seek_) {
    for (PendingReply& reply : *seek_) reply.answer(error);
  }
  for (StepJob& job : steps_) {
    job.reply.answer(error);
    for (Item& item : job.deferred) item.reply.answer(error);
  }
  steps_.clear();
  for (auto& latest : pointers_.take()) {
    for (PendingReply& reply : latest.replies) reply.answer(error);
  }
  for (Item& item : items) item.reply.answer(error);
  reads_.refuse_all(error);
  core_->set_playback(nullptr);
  playback_.reset();
  core_->run().end();
  if (closing) closing->answer(Json{{"tick", core_->run().tick()}});
}

}  // namespace vat
