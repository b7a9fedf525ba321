#pragma once

#include <atomic>
#include <thread>
#include <vector>

#include "core/support/parallel.h"

namespace vat::test {

/// Runs blocks on `count` threads in a varying order, starting with the last block.
class ThreadRunner : public TaskRunner {
 public:
  explicit ThreadRunner(std::size_t count) : count_(count) {}

  void run(std::size_t block_count, const std::function<void(std::size_t)>& block) override {
    ++runs_;
    std::atomic<std::size_t> left = block_count;
    const auto work = [&] {
      for (std::size_t n = left--; n > 0 && n <= block_count; n = left--) block(n - 1);
    };
    std::vector<std::thread> threads;
    for (std::size_t t = 1; t < count_; ++t) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
  }
  std::size_t thread_count() const override { return count_; }
  std::size_t runs() const { return runs_; }

 private:
  std::size_t count_;
  std::size_t runs_ = 0;
};

}  // namespace vat::test
