#pragma once

#include <atomic>
#include <mutex>
#include <thread>

namespace vat {

/// Mutex that can determine whether the calling thread has locked it. Functions that require the
/// lock check is_held(). Use with std::lock_guard and std::unique_lock.
class OwnedMutex {
 public:
  void lock() {
    mutex_.lock();
    holder_.store(std::this_thread::get_id(), std::memory_order_relaxed);
  }
  void unlock() {
    holder_.store({}, std::memory_order_relaxed);
    mutex_.unlock();
  }
  bool is_held() const {
    return holder_.load(std::memory_order_relaxed) == std::this_thread::get_id();
  }

 private:
  std::mutex mutex_;
  std::atomic<std::thread::id> holder_{};
};

}  // namespace vat
