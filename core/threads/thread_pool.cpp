#include "core/threads/thread_pool.h"

#include <algorithm>
#include <limits>
#include <optional>
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
// Remaining time of a run, without help, above which it is shared with helpers that poll: several
// times the time in which cores exchange a job and its results.
constexpr microseconds kWorthSharing(5);
constexpr int kPollsPerTime = 16;

constexpr std::size_t kCaller = 0;  // share of the caller; helper n has share n + 1

thread_local bool is_in_block = false;

/// Marks the calling thread as one that runs a block.
class InBlock {
 public:
  InBlock() : before_(std::exchange(is_in_block, true)) {}
  ~InBlock() { is_in_block = before_; }
  InBlock(const InBlock&) = delete;
  InBlock& operator=(const InBlock&) = delete;

 private:
  const bool before_;
};

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

/// Returns whether `left` blocks take at least the time `least`, if `done` blocks took `elapsed`.
bool is_worth(microseconds least, std::chrono::steady_clock::duration elapsed, std::size_t done,
              std::size_t left) {
  return elapsed * static_cast<std::chrono::steady_clock::rep>(left) >=
         least * static_cast<std::chrono::steady_clock::rep>(done);
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

// The blocks of one thread that have not begun.
class alignas(64) ThreadPoolRunner::Share {
 public:
  // Relaxed: opening and leaving a job order the data between the caller and the helpers.
  void set(std::size_t first, std::size_t end) {
    VAT_CHECK(first <= end && end <= std::numeric_limits<std::uint32_t>::max());
    blocks_.store(pack(first, end), std::memory_order_relaxed);
  }
  std::size_t left() const {
    const std::uint64_t blocks = blocks_.load(std::memory_order_relaxed);
    return end_of(blocks) - first_of(blocks);
  }
  // The owner takes the first block, other threads take the last one.
  std::optional<std::size_t> take(bool is_owner) {
    std::uint64_t blocks = blocks_.load(std::memory_order_relaxed);
    while (first_of(blocks) < end_of(blocks)) {
      const std::size_t first = first_of(blocks);
      const std::size_t end = end_of(blocks);
      const std::uint64_t rest = is_owner ? pack(first + 1, end) : pack(first, end - 1);
      if (blocks_.compare_exchange_weak(blocks, rest, std::memory_order_relaxed)) {
        return is_owner ? first : end - 1;
      }
    }
    return std::nullopt;
  }

 private:
  static constexpr int kHalf = 32;
  static std::uint64_t pack(std::size_t first, std::size_t end) { return end << kHalf | first; }
  static std::size_t first_of(std::uint64_t blocks) {
    return blocks & std::numeric_limits<std::uint32_t>::max();
  }
  static std::size_t end_of(std::uint64_t blocks) { return blocks >> kHalf; }

  std::atomic<std::uint64_t> blocks_ = 0;
};

// A job is open from open() until its caller finds no more blocks. Helpers enter by counting
// themselves, and read the other members only if it was open then. After the end no helper can
// enter. The caller waits for helpers inside, so that none sees the next job's blocks.
//
// Each thread begins with the same part of the blocks in every job. Successive passes over the same
// particles thus find them in the cache of the same core. Then it takes blocks of other threads.
struct ThreadPoolRunner::Job {
  static constexpr std::uint32_t kClosed = 1U << 31;

  std::vector<Share> shares;  // by thread: the caller, then the helpers
  const Block* block = nullptr;
  std::mutex error_mutex;
  std::exception_ptr error;                                 // the first one thrown
  alignas(64) std::atomic<std::uint32_t> inside = kClosed;  // helpers, and kClosed
  std::atomic<bool> is_taken = false;

  explicit Job(std::size_t thread_count) : shares(thread_count) {}

  std::size_t blocks_left() const {
    std::size_t left = 0;
    for (const Share& share : shares) left += share.left();
    return left;
  }

  /// Returns false if it is not open, or no block is left.
  bool enter() {
    if (std::ranges::none_of(shares, [](const Share& share) { return share.left() > 0; })) {
      return false;
    }
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
    const auto begin_of = [&](std::size_t thread) {
      return std::max(first, block_count * thread / shares.size());
    };
    for (std::size_t t = 0; t < shares.size(); ++t) shares[t].set(begin_of(t), begin_of(t + 1));
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

  /// Takes a block of the thread's own share, or else of another one.
  std::optional<std::size_t> take(std::size_t thread) {
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const std::size_t owner = (thread + i) % shares.size();
      if (const auto taken = shares[owner].take(i == 0)) return taken;
    }
    return std::nullopt;
  }

  /// Runs a block. Returns false if none is left.
  bool do_block(std::size_t thread) {
    const std::optional<std::size_t> b = take(thread);
    if (!b) return false;
    const InBlock in_block;
    try {
      (*block)(*b);
    } catch (...) {
      for (Share& share : shares) share.set(0, 0);
      const std::lock_guard lock(error_mutex);
      if (!error) error = std::current_exception();
    }
    return true;
  }
};

ThreadPoolRunner::ThreadPoolRunner(std::size_t thread_count)
    : thread_count_(std::max<std::size_t>(1, thread_count)) {
  try {
    while (jobs_.size() < thread_count_) jobs_.push_back(std::make_unique<Job>(thread_count_));
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
  if (none_polls()) calls_.notify_one();
  work_as_caller(*job);
  job->close();
  const std::exception_ptr error = std::exchange(job->error, nullptr);
  job->is_taken.store(false, std::memory_order_release);
  if (error) std::rethrow_exception(error);
}

// Runs blocks without help: all if no helper is available, or until the rest justifies help.
// Returns their number.
std::size_t ThreadPoolRunner::begin_alone(std::size_t block_count, const Block& block) const {
  const bool is_alone = block_count < 2 || is_in_block || helper_limit() == 0;
  const bool must_wake = none_polls();
  const Clock::time_point begin = is_alone ? Clock::time_point() : Clock::now();
  const InBlock in_block;
  for (std::size_t b = 0; b < block_count; ++b) {
    block(b);
    if (is_alone) continue;
    const Clock::duration elapsed = Clock::now() - begin;
    const std::size_t left = block_count - b - 1;
    if (must_wake ? should_wake(elapsed, b + 1, left)
                  : is_worth(kWorthSharing, elapsed, b + 1, left)) {
      return b + 1;
    }
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
  for (std::size_t done = 1; job.do_block(kCaller); ++done) {
    if (may_wake && should_wake(Clock::now() - begin, done, job.blocks_left())) {
      calls_.notify_one();  // the woken helper wakes the next
      may_wake = false;
    }
  }
}

bool ThreadPoolRunner::is_worth_waking(Clock::duration elapsed, std::size_t done,
                                       std::size_t left) {
  return is_worth(kWorthWaking, elapsed, done, left);
}

bool ThreadPoolRunner::should_wake(Clock::duration elapsed, std::size_t done,
                                   std::size_t left) const {
  return is_worth_waking(elapsed, done, left) && busy_ < helper_limit();
}

bool ThreadPoolRunner::none_polls() const {
  return sleepers_ + busy_ + 1 >= thread_count_;
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
      has_helped = help_with(*jobs_[(number + i) % jobs_.size()], number, has_slept);
    }
  }
  --busy_;
  return has_helped;
}

bool ThreadPoolRunner::help_with(Job& job, std::size_t number, bool has_slept) {
  if (!job.enter()) return false;
  if (has_slept && sleepers_ > 0 && job.blocks_left() > 1) calls_.notify_one();
  while (busy_.load(std::memory_order_relaxed) <= helper_limit() && job.do_block(number + 1)) {
  }
  job.leave();
  return true;
}

}  // namespace vat
