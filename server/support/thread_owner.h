#pragma once

#include <atomic>
#include <thread>

#include "core/support/check.h"

namespace vat {

/// Record of the thread that may use an object (the holder). Without a holder, any single thread
/// may use the object, for example before a session starts. A check costs one relaxed load.
class ThreadOwner {
 public:
  /// Makes the calling thread the holder until the end of the scope. At most one Hold may exist per
  /// owner.
  class Hold {
   public:
    explicit Hold(ThreadOwner& owner) : owner_(owner) {
      std::thread::id none{};
      VAT_CHECK(owner_.holder_.compare_exchange_strong(none, std::this_thread::get_id()));
    }
    ~Hold() { owner_.holder_.store({}, std::memory_order_release); }
    Hold(const Hold&) = delete;
    Hold& operator=(const Hold&) = delete;

   private:
    ThreadOwner& owner_;
  };

  /// Returns false if another thread is the holder.
  bool allows_this_thread() const {
    const std::thread::id holder = holder_.load(std::memory_order_relaxed);
    return holder == std::thread::id() || holder == std::this_thread::get_id();
  }

 private:
  std::atomic<std::thread::id> holder_{};
};

}  // namespace vat
