#include "core/threads/thread_pool.h"

#include <algorithm>
#include <utility>
#include "core/support/check.h"

namespace vat {
namespace {

using std::chrono::microseconds;

// Polling time of a helper before it sleeps: several times the time to wake it. Passes of a step
// follow each other faster, ticks do not.
constexpr microseconds kPollTime(50);
// Remaining time of a run, without help, above which a sleeping helper is woken.
constexpr microseconds kWorthWaking(40);
constexpr int kPollsPerTime = 16;

thread_local bool is_in_block = false;

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

/// Polls until `done()` or `end`, and returns whether it is done. Does not yield: on a busy machine
/// that costs a thread the rest of its time slice, while its caller or helpers wait for it.
template <class Done>
bool poll_until(std::chrono::steady_clock::time_point end, const Done& done) {
  do {
    for (int i = 0; i < kPollsPerTime; ++i) {
      if (done()) return true;
      pause();
    }
  } while (std::chrono::steady_clock::now() < end);
  return done();
}

}  // namespace

// A job is open from open() until its caller finds no more blocks. Helpers enter by counting
// themselves, and read the other members only if it was open then. After the end no helper can
// enter. The caller waits for helpers inside, so that none sees the next job's blocks.
struct ThreadPoolRunner::Job {
  static constexpr std::uint32_t kClosed = 1U << 31;

  alignas(64) std::atomic<std::size_t> next = 0;  // the first block not yet begun
  std::atomic<std::size_t> end = 0;
  const Block* block = nullptr;
  std::mutex error_mutex;
  std::exception_ptr error;                                 // the first one thrown
  alignas(64) std::atomic<std::uint32_t> inside = kClosed;  // helpers, and kClosed
  std::atomic<bool> is_taken = false;

  std::size_t blocks_left() const {
    const std::size_t begun = next.load(std::memory_order_relaxed);
    const std::size_t all = end.load(std::memory_order_relaxed);
    return begun < all ? all - begun : 0;
  }

  /// Returns false if it is not open, or no block is left.
  bool enter() {
    if (blocks_left() == 0) return false;
    if ((inside.fetch_add(1, std::memory_order_acq_rel) & kClosed) == 0) return true;
    leave();
    return false;
  }
  void leave() {
    if (inside.fetch_sub(1, std::memory_order_acq_rel) == (kClosed | 1)) inside.notify_one();
  }
  void open(const Block& task, std::size_t first, std::size_t block_count) {
    VAT_CHECK(first <= block_count);
    block = &task;
    end.store(block_count, std::memory_order_relaxed);
    next.store(first, std::memory_order_relaxed);
    inside.fetch_and(~kClosed, std::memory_order_acq_rel);
  }
  void close() {
    std::uint32_t now = inside.fetch_or(kClosed, std::memory_order_acq_rel) | kClosed;
    const auto is_empty = [&] {
      now = inside.load(std::memory_order_acquire);
      return now == kClosed;
    };
    if (now == kClosed || poll_until(Clock::now() + kPollTime, is_empty)) return;
    for (; now != kClosed; now = inside.load(std::memory_order_acquire)) inside.wait(now);
  }

  /// Runs the next block. Returns false if none is left.
  bool do_block() {
    // Relaxed: opening and leaving order the data between the caller and the helpers.
    const std::size_t b = next.fetch_add(1, std::memory_order_relaxed);
    if (b >= end.load(std::memory_order_relaxed)) return false;
    is_in_block = true;
    try {
      (*block)(b);
    } catch (...) {
      next.store(end.load(std::memory_order_relaxed), std::memory_order_relaxed);
      const std::lock_guard lock(error_mutex);
      if (!error) error = std::current_exception();
    }
    is_in_block = false;
    return true;
  }
};

ThreadPoolRunner::ThreadPoolRunner(std::size_t thread_count)
    : thread_count_(std::max<std::size_t>(1, thread_count)) {
  try {
    while (jobs_.size() < thread_count_) jobs_.push_back(std::make_unique<Job>());
    while (helpers_.size() + 1 < thread_count_) {
      helpers_.emplace_back([this, number = helpers_.size()] { help(number); });
    }
  } catch (...) {
    stop();
    throw;
  }
}

ThreadPoolRunner::~ThreadPoolRunner() {
  stop();
}

void ThreadPoolRunner::stop() {
  stopping_ = true;
  ++calls_;
  calls_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void ThreadPoolRunner::run(std::size_t block_count, const Block& block) {
  VAT_CHECK(block != nullptr);
  const std::size_t begun = begin_alone(block_count, block);
  if (begun == block_count) return;
  Job* const job = take_job();
  if (job == nullptr) {
    for (std::size_t b = begun; b < block_count; ++b) block(b);
    return;
  }
  job->open(block, begun, block_count);
  ++calls_;
  if (begun > 0) calls_.notify_one();
  work_as_caller(*job);
  job->close();
  const std::exception_ptr error = std::exchange(job->error, nullptr);
  job->is_taken.store(false, std::memory_order_release);
  if (error) std::rethrow_exception(error);
}

// Runs blocks without help: all if no helper is available, or, while all helpers sleep, until the
// rest justifies waking one. Returns their number.
std::size_t ThreadPoolRunner::begin_alone(std::size_t block_count, const Block& block) const {
  const bool is_alone = block_count < 2 || is_in_block || helper_limit() == 0;
  if (!is_alone && sleepers_ + 1 < thread_count_) return 0;
  const Clock::time_point begin = is_alone ? Clock::time_point() : Clock::now();
  for (std::size_t b = 0; b < block_count; ++b) {
    block(b);
    if (is_alone) continue;
    if (should_wake(Clock::now() - begin, b + 1, block_count - b - 1)) return b + 1;
  }
  return block_count;
}

ThreadPoolRunner::Job* ThreadPoolRunner::take_job() {
  for (const auto& job : jobs_) {
    if (!job->is_taken.load(std::memory_order_relaxed) &&
        !job->is_taken.exchange(true, std::memory_order_acquire)) {
      return job.get();
    }
  }
  return nullptr;
}

// Wakes sleeping helpers if others are awake.
void ThreadPoolRunner::work_as_caller(Job& job) {
  bool may_wake = sleepers_ > 0;
  const Clock::time_point begin = may_wake ? Clock::now() : Clock::time_point();
  for (std::size_t done = 1; job.do_block(); ++done) {
    if (may_wake && should_wake(Clock::now() - begin, done, job.blocks_left())) {
      calls_.notify_one();  // the woken helper wakes the next
      may_wake = false;
    }
  }
}

bool ThreadPoolRunner::is_worth_waking(Clock::duration elapsed, std::size_t done,
                                       std::size_t left) {
  return elapsed * static_cast<Clock::rep>(left) >= kWorthWaking * static_cast<Clock::rep>(done);
}

bool ThreadPoolRunner::should_wake(Clock::duration elapsed, std::size_t done,
                                   std::size_t left) const {
  return is_worth_waking(elapsed, done, left) && busy_ < helper_limit();
}

std::size_t ThreadPoolRunner::helper_limit() const {
  const std::size_t others =
      std::max<std::size_t>(1, reservations_.load(std::memory_order_relaxed));
  return others < thread_count_ ? thread_count_ - others : 0;
}

void ThreadPoolRunner::help(std::size_t number) {
  pthread_setname_np(pthread_self(), kThreadName);
  bool has_slept = true;
  Clock::time_point end_of_polling;
  while (true) {
    // Read before `stopping_`: otherwise the helper could miss the last call and never wake.
    const std::uint32_t seen = calls_;
    if (stopping_) return;
    if (help_any(number, has_slept)) {
      has_slept = false;
      end_of_polling = Clock::now() + kPollTime;
      continue;
    }
    // Calls of jobs that it may not help do not extend the polling.
    const auto is_called = [&] { return calls_.load(std::memory_order_relaxed) != seen; };
    if (poll_until(end_of_polling, is_called)) continue;
    ++sleepers_;
    calls_.wait(seen);
    --sleepers_;
    has_slept = true;
    end_of_polling = Clock::now() + kPollTime;
  }
}

bool ThreadPoolRunner::help_any(std::size_t number, bool has_slept) {
  bool has_helped = false;
  if (++busy_ <= helper_limit()) {
    // Each helper starts at another job, so that helpers spread over the callers.
    for (std::size_t i = 0; i < jobs_.size() && !has_helped; ++i) {
      has_helped = help_with(*jobs_[(number + i) % jobs_.size()], has_slept);
    }
  }
  --busy_;
  return has_helped;
}

bool ThreadPoolRunner::help_with(Job& job, bool has_slept) {
  if (!job.enter()) return false;
  if (has_slept && sleepers_ > 0 && job.blocks_left() > 1) calls_.notify_one();
  while (busy_.load(std::memory_order_relaxed) <= helper_limit() && job.do_block()) {
  }
  job.leave();
  return true;
}

}  // namespace vat
