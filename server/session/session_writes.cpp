// Writes of a session to its log.

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

#include "core/support/check.h"
#include "server/session/session.h"

namespace vat {

void Session::log_then(std::vector<LogEntry> entries,
                       std::function<void(std::span<const LogEntry>, const Failure&)> work) {
  VAT_CHECK(on_strand() && !wait_);
  core_->history().number(entries);
  if (core_->history().log() == nullptr || entries.empty()) return work(entries, {});
  has_held_inbox_ = false;
  const auto shared = std::make_shared<const std::vector<LogEntry>>(std::move(entries));
  write_then(
      [shared](SessionLog& log, Journal::Done done) { log.append(*shared, std::move(done)); },
      [this, shared, work = std::move(work)](const Failure& failure) {
        SessionLog* const log = core_->history().log();
        if (!failure && log != nullptr) log->confirm(shared->size());
        work(*shared, failure);
      });
}

void Session::write_then(const std::function<void(SessionLog&, Journal::Done)>& write,
                         std::function<void(const Failure&)> then) {
  SessionLog* const log = core_->history().log();
  VAT_CHECK(log != nullptr);
  wait_then(
      [log, write](Journal::Done done) { write(*log, std::move(done)); },
      [this, then = std::move(then)](auto failure) { then(core_->history().note_write(failure)); });
}

void Session::wait_then(const std::function<void(Journal::Done)>& start,
                        std::function<void(std::optional<StorageError::Kind>)> then) {
  VAT_CHECK(on_strand() && !wait_);
  wait_.emplace(
      StorageWait{std::move(then), {}, boost::asio::make_work_guard(strand_.get_inner_executor())});
  start([self = shared_from_this()](std::optional<StorageError::Kind> failure) {
    boost::asio::post(self->strand_, [self, failure] {
      self->wait_->failure = failure;
      self->run_turn(&Session::waited_turn);
    });
  });
}

void Session::waited_turn() {
  VAT_CHECK(wait_.has_value());
  const StorageWait ended = *std::exchange(wait_, std::nullopt);
  ended.then(ended.failure);
  resume_turns();
}

void Session::resume_turns() {
  while (!wait_ && !closed_ && !waiting_turns_.empty()) {
    const Turn turn = waiting_turns_.front();
    waiting_turns_.erase(waiting_turns_.begin());
    (this->*turn)();
  }
}

void Session::store_settings(PendingReply reply, SessionSettings settings) {
  const auto waiting = std::make_shared<PendingReply>(std::move(reply));
  const auto apply = [this, waiting, settings](std::optional<StorageError::Kind> refused) {
    if (refused == StorageError::Kind::name_used) return waiting->answer(name_in_use());
    const Failure failure = core_->history().note_write(refused);
    if (failure) return waiting->answer(*failure);
    core_->people().configure(settings);
    update_summary();
    Json content = core_->people().describe_settings();
    content["tick"] = core_->run().tick();
    waiting->answer(std::move(content));
  };
  if (core_->history().log() == nullptr) return apply({});
  wait_then(
      [log = core_->history().log(), settings](Journal::Done done) {
        log->configure(settings.name, write_settings(settings).dump(), std::move(done));
      },
      apply);
}

SteadyClock::duration Session::write_time() const {
  const SessionLog* const log = core_->history().log();
  if (log == nullptr) return SteadyClock::duration::zero();
  return std::min(log->expected_time(), period_ / 2);
}

bool Session::is_tick_near() const {
  return period_ > SteadyClock::duration::zero() && clock_.now() > ticks_.due() - write_time();
}

void Session::plan_pointers(bool after_tick) {
  // Shortly after a tick, the write may begin even if the next tick is near: a session without time
  // between its ticks would never write.
  pointers_skip_tick_ = !after_tick && is_tick_near();
  const auto time = write_time();
  if (pointers_.empty() || pointers_skip_tick_ || time == SteadyClock::duration::zero()) return;
  pointer_timer_->start(std::max(clock_.now(), ticks_.due() - time),
                        [self = shared_from_this()] { self->run_turn(&Session::pointer_turn); });
}

void Session::end_hold() {
  if (!std::exchange(holds_inbox_, false)) return;
  has_held_inbox_ = true;
  schedule(&Session::inbox_turn);
}

void Session::tell_storage() {
  const auto& failing = core_->history().failing();
  Json params{{"failing", failing.has_value()}};
  if (failing) params["reason"] = to_string(*failing);
  core_->participants().send_event(write_event("session.storage", params));
}

}  // namespace vat
