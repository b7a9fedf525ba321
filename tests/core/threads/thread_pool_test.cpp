#include "core/threads/thread_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <ctime>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/wait.h"

namespace vat::test::thread_pool_test {
namespace {

class TaskRunnerThreads : public testing::TestWithParam<std::size_t> {};

INSTANTIATE_TEST_SUITE_P(Counts, TaskRunnerThreads, testing::Values(1, 2, 4, 7),
                         [](const auto& count) { return "With" + std::to_string(count.param); });

TEST_P(TaskRunnerThreads, RunsEachBlockExactlyOnce) {
  ThreadPoolRunner runner(GetParam());
  EXPECT_EQ(runner.thread_count(), GetParam());
  for (const std::size_t block_count : {0U, 1U, 2U, 3U, 8U, 1000U}) {
    std::vector<std::atomic<int>> calls(block_count);
    runner.run(block_count, [&](std::size_t b) { ++calls.at(b); });
    for (const auto& count : calls) EXPECT_EQ(count, 1);
  }
}

// The blocks write plain memory. Their writes must be visible to the caller, and the caller's
// writes between two runs to the blocks. Otherwise this test or the thread sanitizer fails.
TEST_P(TaskRunnerThreads, ManyRunsSeeEachOthersWrites) {
  ThreadPoolRunner runner(GetParam());
  constexpr std::size_t kBlocks = 5;
  constexpr long kRuns = 20'000;
  std::vector<long> values(kBlocks, 0);
  long offset = 0;
  for (long i = 0; i < kRuns; ++i) {
    offset = i % 3;
    runner.run(kBlocks, [&](std::size_t b) { values[b] += offset; });
  }
  long expected = 0;
  for (long i = 0; i < kRuns; ++i) expected += i % 3;
  EXPECT_EQ(values, std::vector<long>(kBlocks, expected));
}

TEST_P(TaskRunnerThreads, PassesOneExceptionToTheCallerAndStaysUsable) {
  ThreadPoolRunner runner(GetParam());
  for (int i = 0; i < 400; ++i) {
    const auto failing = [&](std::size_t b) {
      if (b == 3 || i % 2 == 0) throw std::runtime_error("block");
    };
    try {
      runner.run(8, failing);
      FAIL() << "the exception was swallowed";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "block");
    }
    std::atomic<int> calls = 0;
    runner.run(8, [&](std::size_t) { ++calls; });
    EXPECT_EQ(calls, 8);
  }
}

// Many runners at once, so that some helpers start late. A helper that missed the stop would never
// end.
TEST(TaskRunner, StopsDuringTheStartOfHelpers) {
  std::vector<std::thread> owners;
  std::atomic<int> stopped = 0;
  constexpr int kOwners = 6;
  constexpr int kRunners = 300;
  for (int owner = 0; owner < kOwners; ++owner) {
    owners.emplace_back([&] {
      for (int k = 0; k < kRunners; ++k) {
        const ThreadPoolRunner runner(7);
        ++stopped;
      }
    });
  }
  for (std::thread& owner : owners) owner.join();
  EXPECT_EQ(stopped, kOwners * kRunners);
}

TEST(TaskRunner, ZeroThreadsMeansTheCallerAlone) {
  ThreadPoolRunner runner(0);
  EXPECT_EQ(runner.thread_count(), 1U);
  std::set<std::thread::id> ids;
  runner.run(10, [&](std::size_t) { ids.insert(std::this_thread::get_id()); });
  EXPECT_EQ(ids, std::set{std::this_thread::get_id()});
}

/// Computes for some milliseconds, so that waking a helper is worthwhile for the rest of the run.
void work() {
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(2);
  while (std::chrono::steady_clock::now() < end) {
  }
}

/// The threads that run blocks. A block waits until enough threads have arrived.
class Threads {
 public:
  explicit Threads(std::size_t expected) : expected_(expected) {}

  bool has_arrived() {
    const std::lock_guard lock(mutex_);
    return ids_.contains(std::this_thread::get_id());
  }
  /// Counts this thread, without waiting for others.
  void note() {
    const std::lock_guard lock(mutex_);
    ids_.insert(std::this_thread::get_id());
    changed_.notify_all();
  }
  /// Counts this thread and waits for the others. Returns false if the expected number of threads
  /// does not arrive.
  bool arrive() {
    constexpr std::chrono::seconds kPatience(60);
    note();
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kPatience, [this] { return ids_.size() >= expected_; });
  }
  std::set<std::thread::id> ids() const { return ids_; }

 private:
  const std::size_t expected_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::set<std::thread::id> ids_;
};

TEST(TaskRunner, ShortRunsWakeNoHelpers) {
  using std::chrono::microseconds;
  const auto is_worth = ThreadPoolRunner::is_worth_waking;
  EXPECT_FALSE(is_worth(microseconds(1), 1, 7));
  EXPECT_FALSE(is_worth(microseconds(39), 1, 1));
  EXPECT_TRUE(is_worth(microseconds(40), 1, 1));
  EXPECT_FALSE(is_worth(microseconds(40), 8, 7));
  EXPECT_TRUE(is_worth(microseconds(40), 8, 8));
  EXPECT_FALSE(is_worth(microseconds(1000), 8, 0)) << "no work is left";
}

/// Runs blocks until `expected` threads have run one. Returns the first block of each thread. A
/// thread waits for the others only in its second block, because the caller wakes a helper between
/// two of its own blocks.
std::map<std::thread::id, std::size_t> first_blocks_of_a_long_run(ThreadPoolRunner& runner,
                                                                  std::size_t expected) {
  Threads threads(expected);
  std::mutex mutex;
  std::map<std::thread::id, std::size_t> first;
  runner.run(10, [&](std::size_t b) {
    {
      const std::lock_guard lock(mutex);
      first.try_emplace(std::this_thread::get_id(), b);
    }
    if (threads.has_arrived()) {
      EXPECT_TRUE(threads.arrive());
    } else {
      work();
      threads.note();
    }
  });
  return first;
}

/// Returns the threads that ran a block of a long run.
std::set<std::thread::id> threads_of_a_long_run(ThreadPoolRunner& runner, std::size_t expected) {
  std::set<std::thread::id> ids;
  for (const auto& [id, block] : first_blocks_of_a_long_run(runner, expected)) ids.insert(id);
  return ids;
}

TEST(TaskRunner, EachThreadBeginsWithItsPartInEveryRun) {
  ThreadPoolRunner runner(2);
  for (int i = 0; i < 3; ++i) {
    for (const auto& [id, block] : first_blocks_of_a_long_run(runner, 2)) {
      EXPECT_EQ(block, id == std::this_thread::get_id() ? 0U : 5U);
    }
  }
}

TEST(TaskRunner, GuestsTakeThePlacesOfHelpers) {
  ThreadPoolRunner runner(3);
  EXPECT_EQ(threads_of_a_long_run(runner, 3).size(), 3U);
  const ThreadPoolRunner::HelperReservation caller(runner);
  EXPECT_EQ(threads_of_a_long_run(runner, 3).size(), 3U) << "the first guest is the caller";
  {
    const ThreadPoolRunner::HelperReservation second(runner);
    const ThreadPoolRunner::HelperReservation third(runner);
    EXPECT_EQ(threads_of_a_long_run(runner, 1), std::set{std::this_thread::get_id()});
    const ThreadPoolRunner::HelperReservation fourth(runner);
    EXPECT_EQ(threads_of_a_long_run(runner, 1), std::set{std::this_thread::get_id()});
  }
  EXPECT_EQ(threads_of_a_long_run(runner, 3).size(), 3U);
}

// A helper may start one block while the guests arrive, but not more.
TEST(TaskRunner, HelpersLeaveForGuests) {
  constexpr std::size_t kThreads = 4;
  ThreadPoolRunner runner(kThreads);
  const auto caller = std::this_thread::get_id();
  std::vector<std::unique_ptr<ThreadPoolRunner::HelperReservation>> guests;
  Threads threads(2);
  std::atomic<bool> guests_are_there = false;
  std::atomic<std::size_t> helped_later = 0;
  runner.run(60, [&](std::size_t b) {
    work();
    if (b == 0) return;
    if (std::this_thread::get_id() != caller) {
      if (guests_are_there) ++helped_later;
      EXPECT_TRUE(threads.arrive());
    } else if (guests.empty()) {
      EXPECT_TRUE(threads.arrive()) << "a helper has arrived";
      while (guests.size() < kThreads) {
        guests.push_back(std::make_unique<ThreadPoolRunner::HelperReservation>(runner));
      }
      guests_are_there = true;
    }
  });
  EXPECT_LE(helped_later, kThreads - 1);
}

// The first caller and its helper stay in their blocks until a helper has run a block of the second
// caller.
TEST(TaskRunner, TwoCallersAreBothHelped) {
  ThreadPoolRunner runner(4);
  Threads first(2);
  Threads second(2);
  std::promise<void> first_is_helped;
  std::promise<void> may_end;
  const auto end = may_end.get_future().share();
  const std::jthread caller([&] {
    // Either thread may be a helper, because helpers that have just started are awake.
    std::atomic<int> arrived = 0;
    runner.run(3, [&](std::size_t b) {
      if (b == 0) return work();
      EXPECT_TRUE(first.arrive());
      if (++arrived == 2) first_is_helped.set_value();
      end.wait();
    });
  });
  first_is_helped.get_future().wait();
  runner.run(3, [&](std::size_t b) {
    if (b == 0) return work();
    EXPECT_TRUE(second.arrive());
  });
  EXPECT_EQ(second.ids().size(), 2U);
  may_end.set_value();
}

// A slow block delays only the caller that it belongs to.
TEST(TaskRunner, ACallerWaitsForItsOwnHelpersOnly) {
  ThreadPoolRunner runner(2);
  Threads threads(2);
  std::promise<void> is_held;
  std::promise<void> may_end;
  std::jthread other([&] {
    const auto own = std::this_thread::get_id();
    runner.run(3, [&](std::size_t b) {
      if (b == 0) return work();
      EXPECT_TRUE(threads.arrive());
      if (std::this_thread::get_id() == own) return;
      is_held.set_value();
      may_end.get_future().wait();
    });
  });
  is_held.get_future().wait();
  std::atomic<int> calls = 0;
  runner.run(100, [&](std::size_t) { ++calls; });
  EXPECT_EQ(calls, 100);
  may_end.set_value();
}

TEST(TaskRunner, RunWithinABlockIsDoneByThatBlock) {
  ThreadPoolRunner runner(3);
  std::atomic<int> calls = 0;
  runner.run(6, [&](std::size_t) {
    const auto outer = std::this_thread::get_id();
    runner.run(5, [&](std::size_t) {
      ++calls;
      work();
      EXPECT_EQ(std::this_thread::get_id(), outer);
    });
  });
  EXPECT_EQ(calls, 30);
}

TEST(TaskRunner, SeveralThreadsMayShareARunner) {
  ThreadPoolRunner runner(3);
  constexpr int kRuns = 2000;
  const auto use = [&runner](std::vector<long>& sums) {
    for (int i = 0; i < kRuns; ++i) runner.run(sums.size(), [&](std::size_t b) { ++sums[b]; });
  };
  std::vector<std::vector<long>> sums(4, std::vector<long>(9, 0));
  {
    std::vector<std::jthread> users;
    for (auto& own : sums) users.emplace_back([&use, &own] { use(own); });
  }
  for (const auto& own : sums) EXPECT_EQ(own, std::vector<long>(9, kRuns));
}

double processor_seconds() {
  timespec used{};
  EXPECT_EQ(clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used), 0);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Returns the processor time of the process during `work`, divided by the elapsed time. It is
/// about 1 for a spinning thread (less on a busy machine), and 0 for sleeping threads.
template <class Work>
double processor_load(const Work& work) {
  const double wall = wall_seconds();
  const double processor = processor_seconds();
  work();
  return (processor_seconds() - processor) / (wall_seconds() - wall);
}

// Covers both waits: helpers between jobs, and the caller for a helper's last block.
TEST(TaskRunner, WaitingThreadsSleep) {
  constexpr double kMaxLoad = 0.25;
  constexpr std::chrono::milliseconds kWait(200);
  ThreadPoolRunner runner(4);
  runner.run(4, [](std::size_t) {});
  EXPECT_LT(processor_load([&] { pause(kWait); }), kMaxLoad);

  const auto caller = std::this_thread::get_id();
  Threads threads(2);
  const auto wait_for_helper = [&](std::size_t b) {
    if (b == 0) return work();
    EXPECT_TRUE(threads.arrive());
    if (std::this_thread::get_id() != caller) pause(kWait);
  };
  EXPECT_LT(processor_load([&] { runner.run(3, wait_for_helper); }), kMaxLoad);
}

}  // namespace
}  // namespace vat::test::thread_pool_test
