#include "server/session/later.h"

#include <spdlog/spdlog.h>

#include <exception>
#include <utility>
#include <vector>

namespace vat {

Later::Later(boost::asio::thread_pool& pool) : timer_(boost::asio::make_strand(pool)) {}

void Later::at(Clock::time_point time, std::function<void()> task) {
  const std::lock_guard lock(mutex_);
  if (stopped_) return;
  const auto added = tasks_.emplace(time, std::move(task));
  if (added == tasks_.begin()) wait();
}

void Later::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  tasks_.clear();
  timer_.cancel();
}

void Later::wait() {
  timer_.expires_at(tasks_.begin()->first);
  timer_.async_wait([self = shared_from_this()](const boost::system::error_code& failure) {
    if (!failure) self->do_what_is_due();
  });
}

void Later::do_what_is_due() {
  std::vector<std::function<void()>> due;
  {
    const std::lock_guard lock(mutex_);
    const auto end = tasks_.upper_bound(Clock::now());
    for (auto task = tasks_.begin(); task != end; ++task) due.push_back(std::move(task->second));
    tasks_.erase(tasks_.begin(), end);
    if (!tasks_.empty()) wait();
  }
  for (const auto& task : due) {
    try {
      task();
    } catch (const std::exception& error) {
      spdlog::error("a delayed task failed: {}", error.what());
    }
  }
}

}  // namespace vat
