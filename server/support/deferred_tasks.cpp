#include "server/support/deferred_tasks.h"

#include <boost/asio/strand.hpp>
#include <exception>
#include <utility>
#include <vector>
#include "core/support/check.h"
#include "server/support/log.h"

namespace vat {

DeferredTasks::DeferredTasks(boost::asio::thread_pool& pool, Clock& clock)
    : clock_(clock), timer_(clock.make_timer(boost::asio::make_strand(pool))) {}

void DeferredTasks::add(SteadyClock::time_point time, std::function<void()> task) {
  VAT_CHECK(task != nullptr);
  const std::lock_guard lock(mutex_);
  if (stopped_) return;
  const auto added = tasks_.emplace(time, std::move(task));
  if (added == tasks_.begin()) wait();
}

void DeferredTasks::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  tasks_.clear();
  timer_->cancel();
}

void DeferredTasks::wait() {
  VAT_CHECK(mutex_.is_held() && !tasks_.empty());
  timer_->start(tasks_.begin()->first, [self = shared_from_this()] { self->run_due_tasks(); });
}

void DeferredTasks::run_due_tasks() {
  std::vector<std::function<void()>> due;
  {
    const std::lock_guard lock(mutex_);
    const auto end = tasks_.upper_bound(clock_.now());
    for (auto task = tasks_.begin(); task != end; ++task) due.push_back(std::move(task->second));
    tasks_.erase(tasks_.begin(), end);
    if (!tasks_.empty()) wait();
  }
  for (const auto& task : due) {
    try {
      task();
    } catch (const std::exception& error) {
      log_error("a deferred task failed: {}", error.what());
    }
  }
}

}  // namespace vat
