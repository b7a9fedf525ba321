#include "server/session/session.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <chrono>
#include <exception>
#include <utility>
#include <vector>

namespace vat {
namespace {

// A turn of the inbox ends after so much, so that ticks and other sessions get theirs.
constexpr std::size_t kCommandsPerTurn = 64;
constexpr auto kTurnTime = std::chrono::milliseconds(10);
// Shorter ones do not hold up others, and are not worth a line to wait in.
constexpr auto kLongTick = std::chrono::milliseconds(5);
constexpr auto kStatusInterval = std::chrono::milliseconds(500);

double seconds(SteadyClock::duration time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace

Session::Session(std::string id, SessionSettings settings, Simulation simulation,
                 ResourceShare share, const SessionEnvironment& environment,
                 boost::asio::thread_pool& pool, SlowTickGate& slow_tick_gate)
    : id_(id),
      clock_(environment.clock),
      strand_(boost::asio::make_strand(pool.get_executor())),
      core_(std::move(id), std::move(settings), std::move(simulation), std::move(share),
            environment),
      tick_timer_(environment.clock.make_timer(strand_)),
      status_timer_(environment.clock.make_timer(strand_)),
      presence_timer_(environment.clock.make_timer(strand_)),
      slow_tick_gate_(slow_tick_gate) {
  update_summary();
}

void Session::recover(SessionRecovery& recovery, Storage& storage,
                      const SessionEnvironment& environment) {
  recovery.finish(core_);
  core_.set_environment(environment);
  core_.run().move_share(environment.resources);
  const std::uint64_t number = recovery.stored().number;
  core_.keep_in(std::make_unique<SessionLog>(
      storage, number,
      SessionLog::Place{storage.sessions().last_sequence(number), core_.run().position(),
                        core_.has_diverged()}));
  core_.come_back(clock_.now());
  update_summary();
}

void Session::start() {
  schedule(&Session::status_turn);
}

void Session::close(End end, std::optional<PendingReply> caller) {
  {
    const std::lock_guard lock(mutex_);
    end_ = end;
    closer_ = std::move(caller);
  }
  schedule(&Session::close_turn);
}

void Session::join(PendingReply caller, std::uint64_t membership, JoinRequest join_request,
                   std::function<void()> undo) {
  put({std::move(caller), Join{membership, std::move(join_request), std::move(undo)}});
}

void Session::disconnect(PendingReply caller) {
  put({std::move(caller), Disconnect{}});
}

void Session::leave(PendingReply caller) {
  put({std::move(caller), Leave{}});
}

void Session::post(PendingReply caller, SessionCommand command) {
  put({std::move(caller), std::move(command)});
}

SessionSummary Session::summary() const {
  const std::lock_guard lock(mutex_);
  return summary_;
}

void Session::post_behind(std::function<void()> task) {
  boost::asio::post(strand_, [self = shared_from_this(), task = std::move(task)]() mutable {
    self->core_.post_behind_frames(std::move(task));
  });
}

void Session::put(Item item) {
  std::unique_lock lock(mutex_);
  if (inbox_closed_) {
    lock.unlock();
    item.caller.answer(no_such_session(id_));
    return;
  }
  inbox_.push_back(std::move(item));
  if (!std::exchange(inbox_scheduled_, true)) schedule(&Session::inbox_turn);
}

void Session::schedule(void (Session::*turn)()) {
  boost::asio::post(strand_, [self = shared_from_this(), turn] { self->run_turn(turn); });
}

void Session::run_turn(void (Session::*turn)()) {
  if (closed_) return;
  const ThreadPoolRunner::HelperReservation guest(core_.environment().runner);
  try {
    (this->*turn)();
    end_turn();
  } catch (const std::exception& error) {
    spdlog::error("session {}: paused by a fault of the server: {}", id_, error.what());
    core_.set_playing(false);
    period_ = {};
    tick_timer_->cancel();
  }
  place_.reset();
}

bool Session::has_place() {
  if (!is_long_ || place_ != nullptr) return true;
  if (waits_for_place_) return false;
  place_ = slow_tick_gate_.take([waiting = weak_from_this()](SlowTickGate::Place place) {
    const auto self = waiting.lock();
    if (self == nullptr) return;
    boost::asio::post(self->strand_, [self, place = std::move(place)]() mutable {
      self->waits_for_place_ = false;
      self->place_ = std::move(place);
      self->run_turn(&Session::place_turn);
      self->place_.reset();  // of a session that is closed there was no turn
    });
  });
  waits_for_place_ = place_ == nullptr;
  return !waits_for_place_;
}

void Session::place_turn() {
  step_turn();
  tick_turn();
}

void Session::end_turn() {
  if (closed_) return;
  if (core_.take_interruption()) end_all_steps();
  if (!tick_is_coming()) carry_out_pointers();
  if (!seek_) core_.announce();
  if (replay_ && !seek_) replay_->tell_people(core_, clock_.now());
  follow_presence();
  note_emptiness(clock_.now());
  follow_clock();
  update_summary();
  keep_moment();
}

void Session::update_summary() {
  SessionSummary summary = core_.summary();
  summary.hibernating = hibernating_ && summary.playing;
  summary.empty_since = empty_since_;
  const std::lock_guard lock(mutex_);
  summary_ = std::move(summary);
}

void Session::inbox_turn() {
  core_.presence().touch();
  const auto end = CostClock::now() + kTurnTime;
  std::optional<Item> item;
  for (std::size_t i = 0; i < kCommandsPerTurn && CostClock::now() < end; ++i) {
    if (!take_item(item)) return;
    try {
      carry_out(*std::move(item));
    } catch (...) {
      schedule(&Session::inbox_turn);  // for the commands that are left
      throw;
    }
  }
  schedule(&Session::inbox_turn);
}

bool Session::take_item(std::optional<Item>& item) {
  const std::lock_guard lock(mutex_);
  if (inbox_.empty()) {
    inbox_scheduled_ = false;
    return false;
  }
  item.emplace(std::move(inbox_.front()));
  inbox_.pop_front();
  return true;
}

void Session::carry_out(Item item) {
  if (std::holds_alternative<Leave>(item.task)) {
    carry_out_leave(std::move(item.caller));
    return;
  }
  if (std::holds_alternative<Disconnect>(item.task)) {
    carry_out_disconnect(item.caller);
    return;
  }
  if (const auto job = find_step(item.caller.client()->id()); job != steps_.end()) {
    job->deferred.push_back(std::move(item));
  } else if (const auto* join = std::get_if<Join>(&item.task)) {
    carry_out_join(std::move(item.caller), *join);
  } else {
    carry_out_command(std::move(item.caller), std::get<SessionCommand>(std::move(item.task)));
  }
}

void Session::carry_out_join(PendingReply caller, const Join& join) {
  carry_out_pointers();  // the connection may have been another participant's
  auto joined = core_.join(caller.client(), join.membership, join.join_request, clock_.now());
  if (auto* error = std::get_if<RpcError>(&joined)) {
    join.undo();
    caller.answer(std::move(*error));
    return;
  }
  const auto& entry = std::get<Entry>(joined);
  update_summary();  // before the answer, here as below: who has it finds in lists what was done
  caller.answer(Json{{"tick", core_.run().tick()},
                     {"session", id_},
                     {"participant", entry.participant.number},
                     {"name", entry.participant.name},
                     {"role", to_string(entry.participant.role)},
                     {"resume", entry.resume},
                     {"resumed", entry.resumed},
                     {"settings", core_.describe_settings()},
                     {"participants", describe_participants(core_.participants())},
                     {"description", core_.description()}});
}

void Session::carry_out_leave(PendingReply caller) {
  const ConnectionId client = caller.client()->id();
  carry_out_pointers();
  end_steps_of(client);
  if (const Participant* participant = core_.participants().find_client(client)) {
    core_.leave(participant->number);
  }
  update_summary();
  caller.answer(Json{{"tick", core_.run().tick()}});
}

void Session::carry_out_disconnect(const PendingReply& caller) {
  carry_out_pointers();
  end_steps_of(caller.client()->id());
  core_.disconnect(caller.client()->id(), clock_.now());
}

void Session::end_steps_of(ConnectionId client) {
  for (auto job = find_step(client); job != steps_.end(); job = find_step(client)) end_step(job);
}

void Session::carry_out_command(PendingReply caller, SessionCommand command) {
  const Participant* participant = core_.participants().find_client(caller.client()->id());
  if (participant == nullptr) {
    caller.answer(not_joined());
    return;
  }
  if (auto error = refuse_role(*command.rules, participant->role)) {
    caller.answer(*std::move(error));
    return;
  }
  if (replay_ && command.rules->is_logged && !is_of_clock(command.rules->method)) {
    caller.answer(not_allowed("the session is a replay: what was done is done"));
    return;
  }
  if (command.rules->is_logged && command.rules->message_class == MessageClass::pointer) {
    pointers_.add(participant->number, std::move(command), std::move(caller));
    return;
  }
  // What came before it: to the session, or from this client.
  const bool is_in_order =
      command.rules->is_logged || command.rules->message_class == MessageClass::control;
  if (is_in_order || pointers_.has_of(participant->number)) carry_out_pointers();
  const SessionCore::ParticipantCommand given{participant->number, command};
  const auto begin = CostClock::now();
  ActionResult result = std::move(core_.carry_out({&given, 1}).front());
  if (core_.log() != nullptr) core_.log()->add_work(CostClock::now() - begin);
  if (core_.take_interruption()) end_all_steps();
  update_summary();
  answer(std::move(caller), std::move(result));
}

void Session::answer(PendingReply caller, ActionResult result) {
  if (const auto* run = std::get_if<RunTicks>(&result)) {
    steps_.push_back({std::move(caller), run->count, {}});
    schedule_step();
  } else if (std::holds_alternative<MakeRecording>(result)) {
    record(std::move(caller));
  } else if (const auto* seek = std::get_if<SeekTo>(&result)) {
    begin_seek(std::move(caller), seek->position);
  } else if (auto* wanted = std::get_if<SaveState>(&result)) {
    save(std::move(caller), std::move(*wanted));
  } else if (auto* error = std::get_if<RpcError>(&result)) {
    caller.answer(std::move(*error));
  } else {
    Json& reply = std::get<Json>(result);
    reply["tick"] = core_.run().tick();
    caller.answer(std::move(reply));
  }
}

bool Session::tick_is_coming() const {
  return core_.playing() || !steps_.empty();
}

void Session::carry_out_pointers() {
  if (pointers_.empty()) return;
  std::vector<PointerCommands::Newest> waiting = pointers_.take();
  std::vector<SessionCore::ParticipantCommand> given;
  given.reserve(waiting.size());
  for (const auto& newest : waiting) given.push_back({newest.participant, newest.command});
  const std::vector<ActionResult> results = core_.carry_out(given);
  for (std::size_t i = 0; i < waiting.size(); ++i) {
    for (PendingReply& caller : waiting[i].callers) answer(std::move(caller), results[i]);
  }
}

std::deque<Session::StepJob>::iterator Session::find_step(ConnectionId client) {
  return std::ranges::find_if(
      steps_, [&](const StepJob& job) { return job.caller.client()->id() == client; });
}

void Session::schedule_step() {
  if (!std::exchange(step_scheduled_, true)) schedule(&Session::step_turn);
}

void Session::step_turn() {
  step_scheduled_ = false;
  if (steps_.empty() || seek_ || !has_place()) return;  // a seek's end goes on with them
  run_tick(clock_.now(), false);
  if (core_.take_interruption()) {
    end_all_steps();
  } else if (--steps_.front().ticks_left == 0) {
    end_step(steps_.begin());
  }
  if (!steps_.empty()) schedule_step();
}

void Session::end_step(std::deque<StepJob>::iterator job) {
  StepJob ended = std::move(*job);
  steps_.erase(job);
  update_summary();
  if (auto error = core_.reach()) {
    ended.caller.answer(*std::move(error));
  } else {
    ended.caller.answer(Json{{"tick", core_.run().tick()}});
  }
  for (Item& item : ended.deferred) carry_out(std::move(item));
}

void Session::end_all_steps() {
  // What was deferred may begin steps of its own, which stay.
  for (std::size_t count = steps_.size(); count > 0 && !steps_.empty(); --count) {
    end_step(steps_.begin());
  }
}

void Session::tick_turn() {
  const auto now = clock_.now();
  // A wait that was over when the clock was stopped or set: it could not be called off any more.
  const bool stands_still = period_ == SteadyClock::duration::zero() || !core_.playing();
  if (stands_still || seek_ || now < ticks_.due()) return;
  if (!has_place()) return;
  core_.environment().metrics.add_lateness(now - ticks_.due());
  run_tick(now, true);
  ticks_.tick_done(clock_.now());
  wait_for_tick();
}

void Session::run_tick(SteadyClock::time_point now, bool timed) {
  carry_out_pointers();
  const auto due = timed ? ticks_.due() : now;
  const auto begin = CostClock::now();
  const bool done = replay_ ? replay_->tick(core_, now, timed) : core_.tick(now, timed);
  const auto stepped = CostClock::now();
  is_long_ = stepped - begin > kLongTick;
  if (SessionLog* const log = core_.log()) {
    log->add_work(stepped - begin);
    const SessionRun& run = core_.run();
    if (done && SessionLog::is_hash_due(run.simulation(), run.position())) {
      log->add_hash(run.position(), run.simulation().state_hash());
    }
  }
  if (!done) return;
  update_summary();  // before the frames: who acknowledges one is told no earlier tick
  core_.publish_tick();
  spdlog::debug("session {}: tick {} took {:.6f} s, publishing {:.6f} s, late {:.6f} s", id_,
                core_.run().tick(), seconds(stepped - begin), seconds(CostClock::now() - stepped),
                seconds(now - due));
}

void Session::note_emptiness(SteadyClock::time_point now) {
  if (!core_.is_empty()) {
    empty_since_.reset();
  } else if (!empty_since_) {
    empty_since_ = now;
  }
  const auto after = core_.environment().limits.hibernate_after;
  const bool hibernates = empty_since_ && after.count() > 0 && now - *empty_since_ >= after;
  if (std::exchange(hibernating_, hibernates) && !hibernates) core_.forget_rate();
}

void Session::follow_clock() {
  const auto wanted = core_.playing() && !hibernating_ && !seek_
                          ? tick_period(core_.run().tick_seconds(), core_.speed())
                          : SteadyClock::duration::zero();
  if (wanted == period_) return;
  period_ = wanted;
  if (period_ == SteadyClock::duration::zero()) {
    tick_timer_->cancel();
    return;
  }
  ticks_.start(clock_.now(), period_);
  wait_for_tick();
}

void Session::wait_for_tick() {
  tick_timer_->start(ticks_.due(),
                     [self = shared_from_this()] { self->run_turn(&Session::tick_turn); });
}

void Session::status_turn() {
  wait_for_status();  // first, so that a fault does not end the statuses
  core_.presence().touch();
  carry_out_pointers();  // they are uses of what they move
  core_.end_idle_grabs(clock_.now());
  core_.end_absences(clock_.now());
  core_.announce_status();
  core_.close_silent(clock_.now());
}

void Session::wait_for_status() {
  status_timer_->start(clock_.now() + kStatusInterval,
                       [self = shared_from_this()] { self->run_turn(&Session::status_turn); });
}

void Session::follow_presence() {
  if (!core_.presence().is_touched() || presence_waits_) return;
  const auto now = clock_.now();
  if (now >= core_.presence().due()) {
    core_.tell_presence(now);
    return;
  }
  presence_waits_ = true;
  presence_timer_->start(core_.presence().due(), [self = shared_from_this()] {
    self->presence_waits_ = false;
    self->run_turn(&Session::presence_turn);
  });
}

void Session::close_turn() {
  closed_ = true;
  tick_timer_->cancel();
  status_timer_->cancel();
  presence_timer_->cancel();
  std::deque<Item> items;
  std::optional<PendingReply> closer;
  End end = End::may_come_back;
  {
    const std::lock_guard lock(mutex_);
    inbox_closed_ = true;
    end = end_;
    items.swap(inbox_);
    closer.swap(closer_);
  }
  end_log(end);
  if (seek_) {
    for (PendingReply& waiting : seek_->callers) waiting.answer(no_such_session(id_));
  }
  for (StepJob& job : steps_) {
    job.caller.answer(no_such_session(id_));
    for (Item& item : job.deferred) item.caller.answer(no_such_session(id_));
  }
  steps_.clear();
  for (auto& newest : pointers_.take()) {
    for (PendingReply& pointer_caller : newest.callers) pointer_caller.answer(no_such_session(id_));
  }
  for (Item& item : items) item.caller.answer(no_such_session(id_));
  core_.show(nullptr);
  replay_.reset();
  core_.run().end();
  if (closer) closer->answer(Json{{"tick", core_.run().tick()}});
}

}  // namespace vat
