#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "server/support/task_runner.h"

namespace vat::bench {

/// Runs one simulation with different numbers of threads, one after the other, so that they start
/// from the same bits and are timed in turn.
class SwitchRunner final : public TaskRunner {
 public:
  /// The last of `thread_counts`, which is not empty, comes first.
  explicit SwitchRunner(const std::vector<std::size_t>& thread_counts) {
    for (const std::size_t count : thread_counts) {
      runners_.push_back(std::make_unique<ThreadPoolRunner>(count));
    }
    present_ = runners_.back().get();
  }

  /// From now on those of `thread_counts[index]`.
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
