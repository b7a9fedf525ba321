#pragma once

#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <map>
#include <memory>

#include "server/support/clock.h"
#include "server/support/owned_mutex.h"

namespace vat {

/// Runs tasks at given times on a thread pool. Safe to use from any thread.
class DeferredTasks : public std::enable_shared_from_this<DeferredTasks> {
 public:
  DeferredTasks(boost::asio::thread_pool& pool, Clock& clock);

  void add(SteadyClock::time_point time, std::function<void()> task);
  /// Drops all tasks that have not begun. Later tasks are dropped too.
  void stop();

 private:
  void wait();  // with the mutex held
  void run_due_tasks();

  Clock& clock_;
  OwnedMutex mutex_;
  std::multimap<SteadyClock::time_point, std::function<void()>> tasks_;
  const std::unique_ptr<Timer> timer_;
  bool stopped_ = false;
};

}  // namespace vat
