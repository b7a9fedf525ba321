// Jobs of control.step.

#include <algorithm>
#include <boost/asio/post.hpp>
#include <iterator>
#include <utility>

#include "core/support/check.h"
#include "server/session/session.h"

namespace vat {

Session::StepJob* Session::find_job(ConnectionId client) {
  for (Steps* const steps : {&ending_steps_, &steps_}) {
    const auto job = std::ranges::find_if(
        *steps, [&](const StepJob& one) { return one.reply.client()->id() == client; });
    if (job != steps->end()) return &*job;
  }
  return nullptr;
}

void Session::end_steps_of(ConnectionId client) {
  const auto is_of_client = [&](const StepJob& job) { return job.reply.client()->id() == client; };
  for (;;) {
    const auto job = std::ranges::find_if(steps_, is_of_client);
    if (job == steps_.end()) return;
    end_step(job);
  }
}

void Session::end_step(Steps::iterator job) {
  VAT_CHECK(job != steps_.end());
  StepJob ended = std::move(*job);
  ended.end_tick = core_->run().tick();
  steps_.erase(job);
  update_summary();
  SessionLog* const log = core_->history().log();
  if (log == nullptr) return answer_step(std::move(ended), {});
  // A recovery must repeat the tick of which the reply informs the client.
  ending_steps_.push_back(std::move(ended));
  log->reach(core_->run().position(),
             [self = shared_from_this(),
              guard = boost::asio::make_work_guard(strand_.get_inner_executor())](auto failure) {
               boost::asio::post(self->strand_, [self, failure] {
                 self->stored_steps_.push_back(failure);
                 self->run_turn(&Session::steps_stored_turn);
               });
             });
}

void Session::steps_stored_turn() {
  while (!wait_ && !stored_steps_.empty()) {
    VAT_CHECK(!ending_steps_.empty());
    const Failure failure = core_->history().note_write(stored_steps_.front());
    StepJob job = std::move(ending_steps_.front());
    stored_steps_.pop_front();
    ending_steps_.pop_front();
    answer_step(std::move(job), failure);
  }
  if (!stored_steps_.empty()) repeat_after_wait(&Session::steps_stored_turn);
}

void Session::answer_step(StepJob job, const Failure& failure) {
  if (failure) {
    job.reply.answer(*failure);
  } else {
    job.reply.answer(Json{{"tick", job.end_tick}});
  }
  put_back_.insert(put_back_.begin(), std::make_move_iterator(job.deferred.begin()),
                   std::make_move_iterator(job.deferred.end()));
  while (!wait_ && !holds_inbox_ && !put_back_.empty()) {
    Item item = std::move(put_back_.front());
    put_back_.pop_front();
    if (put_back(item)) return;
    execute(std::move(item));
  }
  if (wait_ && !put_back_.empty()) repeat_after_wait(&Session::inbox_turn);
}

void Session::end_all_steps() {
  // Deferred requests may start new steps, which stay.
  for (std::size_t count = steps_.size(); count > 0 && !steps_.empty(); --count) {
    end_step(steps_.begin());
  }
}

}  // namespace vat
