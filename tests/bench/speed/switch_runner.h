#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "core/threads/thread_pool.h"

namespace vat::bench {

/// Runs one simulation with alternating numbers of threads, so that all start from the same bits
/// and are timed in turn.
class SwitchRunner final : public TaskRunner {
 public:
  /// Starts with the last of `thread_counts`, which must not be empty.
  explicit SwitchRunner(const std::vector<std::size_t>& thread_counts) {
    for (const std::size_t count : thread_counts) {
      runners_.push_back(std::make_unique<ThreadPoolRunner>(count));
    }
    present_ = runners_.back().get();
  }

  /// Uses `thread_counts[index]` threads from now on.
  void choose(std::size_t index) { present_ = runners_.at(index).get(); }

  void run(std::size_t block_count, const std::function<void(std::size_t)>& block) override {
    present_->run(block_count, block);
  }
  std::size_t thread_count() const override { return present_->thread_count(); }

 private:
  std::vector<std::unique_ptr<ThreadPoolRunner>> runners_;
  ThreadPoolRunner* present_ = nullptr;
};

}  // namespace vat::bench
