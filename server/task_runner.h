#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "core/support/parallel.h"

namespace vat {

/// A TaskRunner with threads of its own. The thread that calls run() works too, and does not wait
/// for helpers that have not woken yet, so that short runs stay cheap. Idle threads sleep.
///
/// If a block throws, the blocks not yet begun are left out and run() throws the same exception;
/// the runner stays usable. A run() that begins during another one, from a second thread or from
/// within a block, is done by its caller alone.
class ThreadPoolRunner final : public TaskRunner {
 public:
  /// `thread_count` counts the calling thread, so 1 (or 0) starts none. Throws std::system_error
  /// where the system refuses a thread.
  explicit ThreadPoolRunner(std::size_t thread_count);
  ~ThreadPoolRunner() override;
  ThreadPoolRunner(const ThreadPoolRunner&) = delete;
  ThreadPoolRunner& operator=(const ThreadPoolRunner&) = delete;

  void run(std::size_t block_count, const std::function<void(std::size_t)>& block) override;
  std::size_t thread_count() const override { return helpers_.size() + 1; }

 private:
  using Block = std::function<void(std::size_t)>;
  void help();
  void work(const Block& block, std::size_t block_count);
  void open_job(const Block& block, std::size_t block_count);
  std::exception_ptr close_job();
  void stop();

  std::atomic<bool> running_ = false;        // a job is under way
  std::atomic<std::size_t> next_block_ = 0;  // of the job; the first not yet begun

  std::mutex mutex_;  // guards what follows
  std::condition_variable wake_;
  std::condition_variable idle_;
  const Block* block_ = nullptr;  // null: no job that a helper could join
  std::size_t block_count_ = 0;
  std::uint64_t job_ = 0;       // number of the job: a helper joins each at most once
  std::size_t busy_count_ = 0;  // helpers at work
  std::exception_ptr error_;    // the first one thrown in the job
  bool stopping_ = false;

  std::vector<std::thread> helpers_;
};

}  // namespace vat
