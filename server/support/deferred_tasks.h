#pragma once

#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <map>
#include <memory>

#include "server/support/clock.h"
#include "server/support/owned_mutex.h"

namespace vat {

/// Scheduler that runs tasks at given times on a thread pool. Thread-safe.
class DeferredTasks : public std::enable_shared_from_this<DeferredTasks> {
 public:
  DeferredTasks(boost::asio::thread_pool& pool, Clock& clock);

  void add(SteadyClock::time_point time, std::function<void()> task);
  /// Drops all tasks that have not begun, and all tasks that are added later.
  void stop();

 private:
  void wait();  // the caller must hold the mutex
  void run_due_tasks();

  Clock& clock_;
  OwnedMutex mutex_;
  std::multimap<SteadyClock::time_point, std::function<void()>> tasks_;
  const std::unique_ptr<Timer> timer_;
  bool stopped_ = false;
};

}  // namespace vat
