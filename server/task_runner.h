#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "core/support/parallel.h"

namespace vat {

/// A TaskRunner with threads of its own, which help whoever calls run(), several callers at once
/// too. A caller works itself, and waits only for helpers that have begun a block.
///
/// Who waits looks for some microseconds, since passes of a step follow one another faster than a
/// thread wakes, and then sleeps. Sleeping helpers are woken where a run has shown itself long
/// enough to be worth that: short ones, as of small scenes, stay with their callers.
///
/// If a block throws, the blocks not yet begun are left out and run() throws the same exception;
/// the runner stays usable. A run() from within a block is done by its thread alone.
class ThreadPoolRunner final : public TaskRunner {
 public:
  /// Of the helping threads, as the system lists them.
  static constexpr const char* kThreadName = "vat-helper";

  /// `thread_count` counts one calling thread, so 1 (or 0) starts none. Throws std::system_error
  /// where the system refuses a thread.
  explicit ThreadPoolRunner(std::size_t thread_count);
  ~ThreadPoolRunner() override;
  ThreadPoolRunner(const ThreadPoolRunner&) = delete;
  ThreadPoolRunner& operator=(const ThreadPoolRunner&) = delete;

  void run(std::size_t block_count, const std::function<void(std::size_t)>& block) override;
  std::size_t thread_count() const override { return thread_count_; }

  using Clock = std::chrono::steady_clock;
  /// Whether a sleeping helper is worth waking after `done` blocks of a run took `elapsed` and
  /// `left` blocks have not begun.
  static bool is_worth_waking(Clock::duration elapsed, std::size_t done, std::size_t left);

  /// While it lives, a thread of another pool has work of its own. Helpers beyond thread_count()
  /// less the guests stop at the end of their blocks, so that no more threads than that run for
  /// long: work of its own first, help second.
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
  struct Job;

  std::size_t begin_alone(std::size_t block_count, const Block& block) const;
  Job* take_job();
  void work_as_caller(Job& job);
  bool should_wake(Clock::duration elapsed, std::size_t done, std::size_t left) const;
  void help(std::size_t number);
  bool help_any(std::size_t number, bool has_slept);
  bool help_with(Job& job, bool has_slept);
  std::size_t helper_limit() const;
  void stop();

  const std::size_t thread_count_;
  std::vector<std::unique_ptr<Job>> jobs_;  // as many as may run at once
  // Counts jobs that were opened: what helpers wait for.
  alignas(64) std::atomic<std::uint32_t> calls_ = 0;
  alignas(64) std::atomic<std::uint32_t> sleepers_ = 0;  // helpers
  std::atomic<std::uint32_t> busy_ = 0;                  // helpers at work
  std::atomic<std::uint32_t> reservations_ = 0;
  std::atomic<bool> stopping_ = false;
  std::vector<std::thread> helpers_;
};

}  // namespace vat
