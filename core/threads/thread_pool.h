#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "core/support/parallel.h"

namespace vat {

/// TaskRunner with helper threads for callers of run(). Several threads can call run() at the same
/// time. A caller executes blocks itself, and waits only for helpers that have started a block.
///
/// Each thread begins with the same contiguous part of the blocks in every run, so that passes over
/// the same data find it in the cache of the same core. A thread without blocks takes those of
/// other threads.
///
/// Helpers poll for some microseconds before they sleep, because consecutive passes of a step have
/// shorter gaps than the wake-up time of a thread. A run wakes sleeping helpers only if the run is
/// long enough.
///
/// If a block throws an exception, blocks that have not started are skipped, and run() throws the
/// same exception. The runner remains usable. A run() inside a block uses only the calling thread.
class ThreadPoolRunner final : public TaskRunner {
 public:
  /// Name of the helper threads in the system's list of threads.
  static constexpr const char* kThreadName = "vat-helper";

  /// `thread_count` includes the calling thread, so that 1 (or 0) starts no helpers. Throws
  /// std::system_error if a thread cannot be started.
  explicit ThreadPoolRunner(std::size_t thread_count);
  ~ThreadPoolRunner() override;
  ThreadPoolRunner(const ThreadPoolRunner&) = delete;
  ThreadPoolRunner& operator=(const ThreadPoolRunner&) = delete;

  void run(std::size_t block_count, const std::function<void(std::size_t)>& block) override;
  std::size_t thread_count() const override { return thread_count_; }

  using Clock = std::chrono::steady_clock;
  /// Returns whether to wake a sleeping helper. `done` blocks of the run took the time `elapsed`,
  /// and `left` blocks have not started.
  static bool is_worth_waking(Clock::duration elapsed, std::size_t done, std::size_t left);

  /// Limit of this runner's helpers while a thread of another pool is busy. The number of active
  /// helpers is thread_count() minus the number of reservations. Other helpers stop after their
  /// current block.
  class HelperReservation {
   public:
    explicit HelperReservation(ThreadPoolRunner& host) : host_(host) { ++host_.reservations_; }
    ~HelperReservation() { --host_.reservations_; }
    HelperReservation(const HelperReservation&) = delete;
    HelperReservation& operator=(const HelperReservation&) = delete;

   private:
    ThreadPoolRunner& host_;
  };

 private:
  using Block = std::function<void(std::size_t)>;
  class Share;
  struct Job;

  std::size_t begin_alone(std::size_t block_count, const Block& block) const;
  Job* take_job();
  void work_as_caller(Job& job);
  bool should_wake(Clock::duration elapsed, std::size_t done, std::size_t left) const;
  void help(std::size_t number);
  bool help_any(std::size_t number, bool has_slept);
  bool help_with(Job& job, std::size_t number, bool has_slept);
  bool none_polls() const;  // all helpers sleep or work
  std::size_t helper_limit() const;
  void stop();

  const std::size_t thread_count_;
  std::vector<std::unique_ptr<Job>> jobs_;  // as many jobs as can run at the same time
  // Number of opened jobs. Helpers wait for a change of the number.
  alignas(64) std::atomic<std::uint32_t> calls_ = 0;
  alignas(64) std::atomic<std::uint32_t> sleepers_ = 0;  // sleeping helpers
  std::atomic<std::uint32_t> busy_ = 0;                  // working helpers
  std::atomic<std::uint32_t> reservations_ = 0;
  std::atomic<bool> stopping_ = false;
  std::vector<std::thread> helpers_;
};

}  // namespace vat
