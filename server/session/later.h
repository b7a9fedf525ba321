#pragma once

#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

namespace vat {

/// Does things later, on a pool. Safe to use from any thread.
class Later : public std::enable_shared_from_this<Later> {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Later(boost::asio::thread_pool& pool);

  void at(Clock::time_point time, std::function<void()> task);
  /// Drops what is not done yet; nothing is done afterwards, but for what is under way.
  void stop();

 private:
  void wait();  // with the mutex held
  void do_what_is_due();

  std::mutex mutex_;
  std::multimap<Clock::time_point, std::function<void()>> tasks_;
  boost::asio::steady_timer timer_;
  bool stopped_ = false;
};

}  // namespace vat
