// Ticks and timers of a session.

#include <chrono>
#include <utility>

#include "core/support/check.h"
#include "server/session/session.h"
#include "server/support/log.h"

namespace vat {
namespace {

// Shorter ticks do not delay other sessions, and need no place among the slow ones.
constexpr auto kSlowTick = std::chrono::milliseconds(5);
constexpr auto kStatusInterval = std::chrono::milliseconds(500);
// A turn of a seek ends after this, so that other sessions get theirs.
constexpr auto kSeekTurnTime = std::chrono::milliseconds(10);

double seconds(SteadyClock::duration time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace

bool Session::has_place() {
  VAT_CHECK(on_strand());
  if (!is_slow_ || place_ != nullptr) return true;
  if (waits_for_place_) return false;
  place_ = slow_tick_gate_.take([waiting = weak_from_this()](SlowTickGate::Place place) {
    const auto self = waiting.lock();
    if (self == nullptr) return;
    boost::asio::post(self->strand_, [self, place = std::move(place)]() mutable {
      self->waits_for_place_ = false;
      self->place_ = std::move(place);
      self->run_turn(&Session::place_turn);
      self->place_.reset();  // a closed session runs no turn
    });
  });
  waits_for_place_ = place_ == nullptr;
  return !waits_for_place_;
}

void Session::place_turn() {
  step_turn();
  tick_turn();
}

void Session::schedule_step() {
  if (!std::exchange(step_scheduled_, true)) schedule(&Session::step_turn);
}

void Session::step_turn() {
  step_scheduled_ = false;
  if (steps_.empty() || seek_) return;  // end_seek() continues the steps
  if (!execute_pointers()) {
    step_scheduled_ = true;
    return repeat_after_wait(&Session::step_turn);
  }
  if (!has_place()) return;
  run_tick(clock_.now(), false);
  if (core_->clock().take_interruption()) {
    end_all_steps();
  } else if (--steps_.front().ticks_left == 0) {
    end_step(steps_.begin());
  }
  if (!steps_.empty()) schedule_step();
}

void Session::tick_turn() {
  const auto now = clock_.now();
  // A timer may have fired before the session was paused or its speed changed.
  const bool is_off = period_ == SteadyClock::duration::zero() || !core_->clock().playing();
  if (is_off || seek_ || now < ticks_.due()) return;
  if (wait_) return repeat_after_wait(&Session::tick_turn);
  if (!pointers_skip_tick_ && !execute_pointers()) return repeat_after_wait(&Session::tick_turn);
  if (!has_place()) return;
  core_->environment().metrics.add_lateness(now - ticks_.due());
  run_tick(now, true);
  ticks_.tick_done(clock_.now());
  wait_for_tick();
  plan_pointers(true);
  end_hold();
}

void Session::run_tick(SteadyClock::time_point now, bool timed) {
  VAT_CHECK(on_strand() && !seek_ && !wait_);
  const auto due = timed ? ticks_.due() : now;
  const auto begin = CostClock::now();
  const bool done = playback_ ? playback_->tick(*core_, now, timed) : core_->tick(now, timed);
  const auto stepped = CostClock::now();
  is_slow_ = stepped - begin > kSlowTick;
  const SessionRun& run = core_->run();
  if (SessionLog* const log = core_->history().log()) {
    log->add_work(stepped - begin);
    if (done && SessionLog::is_hash_due(run.simulation(), run.position())) {
      log->add_hash(run.position(), run.simulation().state_hash());
    }
  }
  if (!done) return;
  update_summary();  // before the frame: its acknowledgement is answered with this tick or later
  core_->notifier().publish_tick();
  const auto published = CostClock::now();
  if (timed && !playback_) governor_.add_tick(clock_.now() - now);
  if (timed && published - begin > period_) {
    const auto stages = run.profile().spans();
    core_->environment().metrics.slow_ticks().add({id(),
                                                   run.tick(),
                                                   period_,
                                                   begin - (now - due),
                                                   begin,
                                                   stepped,
                                                   published,
                                                   {stages.begin(), stages.end()}});
  }
  log_debug("session {}: tick {} took {:.6f} s, publishing {:.6f} s, late {:.6f} s", id(),
            run.tick(), seconds(stepped - begin), seconds(published - stepped), seconds(now - due));
}

void Session::begin_seek(PendingReply reply, std::uint64_t position) {
  VAT_CHECK(playback_ != nullptr);
  end_all_steps();
  if (!seek_) seek_.emplace();
  seek_->push_back(std::move(reply));
  playback_->begin_seek(*core_, position);
  if (!std::exchange(seek_scheduled_, true)) schedule(&Session::seek_turn);
}

void Session::seek_turn() {
  seek_scheduled_ = false;
  if (!seek_) return;
  if (playback_->continue_seek(*core_, CostClock::now() + kSeekTurnTime)) return end_seek();
  seek_scheduled_ = true;
  schedule(&Session::seek_turn);
}

void Session::end_seek() {
  VAT_CHECK(seek_.has_value());
  std::vector<PendingReply> replies = *std::exchange(seek_, std::nullopt);
  playback_->end_seek(*core_);
  core_->clock().take_interruption();
  period_ = {};  // follow_clock() starts the timer anew
  update_summary();
  for (PendingReply& reply : replies) {
    reply.answer(Json{{"tick", core_->run().tick()}, {"position", core_->run().position()}});
  }
  if (!steps_.empty()) schedule_step();
}

void Session::note_emptiness(SteadyClock::time_point now) {
  const Participants& participants = core_->participants();
  if (participants.connected() > 0 || participants.away() > 0) {
    empty_since_.reset();
  } else if (!empty_since_) {
    empty_since_ = now;
  }
  const auto after = core_->environment().limits.hibernate_after;
  const bool hibernates = empty_since_ && after.count() > 0 && now - *empty_since_ >= after;
  if (std::exchange(hibernating_, hibernates) && !hibernates) core_->clock().restart_rate();
}

void Session::follow_clock() {
  const SessionClock& clock = core_->clock();
  const SessionLog* const log = core_->history().log();
  const bool is_suspended = log != nullptr && log->is_suspended();
  const auto wanted = clock.playing() && !hibernating_ && !seek_ && !is_suspended
                          ? tick_period(core_->run().tick_seconds(), clock.speed())
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
  VAT_CHECK(period_ > SteadyClock::duration::zero());
  tick_timer_->start(ticks_.due(),
                     [self = shared_from_this()] { self->run_turn(&Session::tick_turn); });
}

void Session::status_turn() {
  wait_for_status();  // first, so that a fault does not end the statuses
  core_->notifier().presence().touch();
  // They count as moves of their grabs.
  if (!execute_pointers()) return repeat_after_wait(&Session::upkeep_turn);
  upkeep_turn();
}

void Session::upkeep_turn() {
  const std::vector<SessionCore::IdleGrab> idle = core_->idle_grabs(clock_.now());
  Commands commands;
  for (const auto& [participant, grab, body] : idle) {
    const SessionMethods& methods = core_->environment().methods;
    commands.push_back({participant, methods.make("grab.end", {{"grab", grab}}), {}});
  }
  if (!playback_) {
    if (auto command = governor_.next_command(*core_, clock_.now(), period_)) {
      commands.push_back({kServerItself, *std::move(command), {}});
    }
  }
  run_commands(std::move(commands), [this, idle] {
    for (const SessionCore::IdleGrab& one : idle) core_->tell_idle_grab(one);
    governor_.tell_switch(*core_);
  });
  core_->notifier().announce_status();
  core_->participants().close_silent(clock_.now(), core_->environment().limits.frame_patience);
}

void Session::wait_for_status() {
  status_timer_->start(clock_.now() + kStatusInterval,
                       [self = shared_from_this()] { self->run_turn(&Session::status_turn); });
}

void Session::follow_presence() {
  SessionNotifier& notifier = core_->notifier();
  if (!notifier.presence().is_touched() || presence_waits_) return;
  const auto now = clock_.now();
  if (now >= notifier.presence().due()) {
    notifier.tell_presence(now);
    return;
  }
  presence_waits_ = true;
  presence_timer_->start(notifier.presence().due(), [self = shared_from_this()] {
    self->presence_waits_ = false;
    self->run_turn(&Session::presence_turn);
  });
}

void Session::store_progress() {
  SessionHistory& history = core_->history();
  SessionLog* const log = history.log();
  const auto now = clock_.now();
  if (log != nullptr &&
      log->is_due(core_->run().position(), core_->participants().changes(), now)) {
    log->store(history.moment(), now);
  }
}

void Session::end_log(End end) {
  SessionHistory& history = core_->history();
  const std::unique_ptr<SessionLog> log = history.end_log();
  if (log == nullptr) return;
  if (end == End::closed) {
    log->close();
  } else if (end == End::resumable && !history.divergence()) {
    log->store(history.moment(), clock_.now(), true);
  }
}

}  // namespace vat
