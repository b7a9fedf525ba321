#include "server/task_runner.h"

#include <algorithm>
#include <utility>

namespace vat {

ThreadPoolRunner::ThreadPoolRunner(std::size_t thread_count) {
  try {
    while (helpers_.size() + 1 < thread_count) helpers_.emplace_back([this] { help(); });
  } catch (...) {
    stop();
    throw;
  }
}

ThreadPoolRunner::~ThreadPoolRunner() {
  stop();
}

void ThreadPoolRunner::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void ThreadPoolRunner::run(std::size_t block_count, const Block& block) {
  const bool alone = helpers_.empty() || block_count < 2 || running_.exchange(true);
  if (alone) {
    for (std::size_t b = 0; b < block_count; ++b) block(b);
    return;
  }
  open_job(block, block_count);
  work(block, block_count);
  const std::exception_ptr error = close_job();
  running_.store(false);
  if (error) std::rethrow_exception(error);
}

void ThreadPoolRunner::open_job(const Block& block, std::size_t block_count) {
  {
    const std::lock_guard lock(mutex_);
    block_ = &block;
    block_count_ = block_count;
    next_block_.store(0, std::memory_order_relaxed);
    ++job_;
  }
  // The caller takes a block itself.
  const std::size_t wanted = std::min(helpers_.size(), block_count - 1);
  for (std::size_t i = 0; i < wanted; ++i) wake_.notify_one();
}

// From here on no helper can join; those at work are waited for, so that none sees the next job's
// counters or a block function that is gone.
std::exception_ptr ThreadPoolRunner::close_job() {
  std::unique_lock lock(mutex_);
  block_ = nullptr;
  idle_.wait(lock, [this] { return busy_count_ == 0; });
  return std::exchange(error_, nullptr);
}

void ThreadPoolRunner::work(const Block& block, std::size_t block_count) {
  try {
    for (;;) {
      // Relaxed: the mutex orders the data between the caller and the helpers.
      const std::size_t b = next_block_.fetch_add(1, std::memory_order_relaxed);
      if (b >= block_count) return;
      block(b);
    }
  } catch (...) {
    next_block_.store(block_count, std::memory_order_relaxed);
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = std::current_exception();
  }
}

void ThreadPoolRunner::help() {
  std::uint64_t last_job = 0;
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [&] { return stopping_ || (block_ != nullptr && job_ != last_job); });
    if (stopping_) return;
    last_job = job_;
    const Block& block = *block_;
    const std::size_t block_count = block_count_;
    ++busy_count_;
    lock.unlock();
    work(block, block_count);
    lock.lock();
    if (--busy_count_ == 0) idle_.notify_one();
  }
}

}  // namespace vat
