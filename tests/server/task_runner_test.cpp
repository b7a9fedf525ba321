#include "server/task_runner.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace vat::task_runner_test {
namespace {

class TaskRunnerThreads : public testing::TestWithParam<std::size_t> {};

INSTANTIATE_TEST_SUITE_P(Counts, TaskRunnerThreads, testing::Values(1, 2, 4, 7),
                         [](const auto& count) { return "With" + std::to_string(count.param); });

TEST_P(TaskRunnerThreads, RunsEachBlockExactlyOnce) {
  ThreadPoolRunner runner(GetParam());
  EXPECT_EQ(runner.thread_count(), GetParam());
  for (const std::size_t block_count : {0, 1, 2, 3, 8, 1000}) {
    std::vector<std::atomic<int>> calls(block_count);
    runner.run(block_count, [&](std::size_t b) { ++calls.at(b); });
    for (const auto& count : calls) EXPECT_EQ(count, 1);
  }
}

// The blocks write plain memory: what they wrote must be visible to the caller, and what the caller
// writes between two runs to the blocks, or this test fails here or under the thread sanitizer.
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

TEST_P(TaskRunnerThreads, PassesAnExceptionToTheCallerAndStaysUsable) {
  ThreadPoolRunner runner(GetParam());
  const auto failing = [](std::size_t b) {
    if (b == 3) throw std::runtime_error("block 3");
  };
  for (int i = 0; i < 200; ++i) {
    try {
      runner.run(8, failing);
      FAIL() << "the exception was swallowed";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "block 3");
    }
    std::atomic<int> calls = 0;
    runner.run(8, [&](std::size_t) { ++calls; });
    EXPECT_EQ(calls, 8);
  }
}

TEST_P(TaskRunnerThreads, SeveralThrowingBlocksGiveOneException) {
  ThreadPoolRunner runner(GetParam());
  for (int i = 0; i < 200; ++i) {
    EXPECT_THROW(runner.run(16, [](std::size_t) { throw std::logic_error("each"); }),
                 std::logic_error);
  }
}

// Many at once, so that some helpers are late: one that missed the call to stop would never end.
TEST(TaskRunner, StopsWhereHelpersHaveHardlyBegun) {
  std::vector<std::thread> owners;
  std::atomic<int> stopped = 0;
  constexpr int kOwners = 6;
  constexpr int kRunners = 2000;
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

/// Waits until two blocks have come here: that needs two threads. False after ten seconds.
bool meet(std::atomic<int>& arrived) {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + std::chrono::seconds(10);
  ++arrived;
  while (arrived < 2 && Clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return arrived >= 2;
}

TEST(TaskRunner, TheCallerAndASleepingHelperWorkAtOnce) {
  ThreadPoolRunner runner(2);
  for (int i = 0; i < 3; ++i) {
    // Long enough for the helper to fall asleep, as a rule: the test holds for one that has not.
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    std::atomic<int> arrived = 0;
    std::atomic<int> met = 0;
    runner.run(3, [&](std::size_t b) {
      if (b == 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));  // worth waking someone
      } else if (meet(arrived)) {
        ++met;
      }
    });
    ASSERT_EQ(met, 2);
  }
}

// All but the run that the system happens to interrupt.
TEST(TaskRunner, ShortRunsWakeNobody) {
  constexpr int kRuns = 100;
  ThreadPoolRunner runner(4);
  const auto caller = std::this_thread::get_id();
  int alone = 0;
  for (int i = 0; i < kRuns; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::atomic<int> by_others = 0;
    runner.run(8, [&](std::size_t) {
      if (std::this_thread::get_id() != caller) ++by_others;
    });
    if (by_others == 0) ++alone;
  }
  EXPECT_GE(alone, kRuns * 9 / 10);
}

/// Runs blocks of a millisecond each, so that all helpers come; who did them.
std::set<std::thread::id> threads_of_a_long_run(ThreadPoolRunner& runner) {
  std::mutex mutex;
  std::set<std::thread::id> ids;
  runner.run(60, [&](std::size_t) {
    {
      const std::lock_guard lock(mutex);
      ids.insert(std::this_thread::get_id());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  return ids;
}

TEST(TaskRunner, GuestsTakeThePlacesOfHelpers) {
  ThreadPoolRunner runner(3);
  EXPECT_EQ(threads_of_a_long_run(runner).size(), 3U);
  const ThreadPoolRunner::Guest caller(runner);
  EXPECT_EQ(threads_of_a_long_run(runner).size(), 3U) << "the first guest is the caller";
  {
    const ThreadPoolRunner::Guest second(runner);
    const ThreadPoolRunner::Guest third(runner);
    EXPECT_EQ(threads_of_a_long_run(runner), std::set{std::this_thread::get_id()});
    const ThreadPoolRunner::Guest fourth(runner);
    EXPECT_EQ(threads_of_a_long_run(runner), std::set{std::this_thread::get_id()});
  }
  EXPECT_EQ(threads_of_a_long_run(runner).size(), 3U);
}

// A helper may be about to begin a block as the guests come, but no more than that one.
TEST(TaskRunner, HelpersLeaveForGuests) {
  constexpr std::size_t kThreads = 4;
  ThreadPoolRunner runner(kThreads);
  const auto caller = std::this_thread::get_id();
  std::vector<std::unique_ptr<ThreadPoolRunner::Guest>> guests;
  std::atomic<bool> guests_are_there = false;
  std::atomic<std::size_t> helped_before = 0;
  std::atomic<std::size_t> helped_later = 0;
  int own_blocks = 0;
  runner.run(200, [&](std::size_t) {
    if (std::this_thread::get_id() != caller) {
      ++(guests_are_there ? helped_later : helped_before);
    } else if (++own_blocks == 10) {
      while (guests.size() < kThreads) {
        guests.push_back(std::make_unique<ThreadPoolRunner::Guest>(runner));
      }
      guests_are_there = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  EXPECT_GT(helped_before, 0U);
  EXPECT_LE(helped_later, kThreads - 1);
}

TEST(TaskRunner, TwoCallersAreBothHelped) {
  ThreadPoolRunner runner(4);
  std::vector<std::set<std::thread::id>> ids(2);
  {
    std::vector<std::jthread> callers;
    for (auto& own : ids) {
      callers.emplace_back([&runner, &own] { own = threads_of_a_long_run(runner); });
    }
  }
  for (const auto& own : ids) EXPECT_GE(own.size(), 2U);
}

TEST(TaskRunner, RunWithinABlockIsDoneByThatBlock) {
  ThreadPoolRunner runner(3);
  std::atomic<int> calls = 0;
  runner.run(6, [&](std::size_t) { runner.run(5, [&](std::size_t) { ++calls; }); });
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

/// Processor time of the whole process while `work` runs, over the time that it took. A thread that
/// spins has about 1, and on a busy machine its share of a core; threads that sleep have 0.
template <class Work>
double processor_load(const Work& work) {
  const double wall = wall_seconds();
  const double processor = processor_seconds();
  work();
  return (processor_seconds() - processor) / (wall_seconds() - wall);
}

// Both waits: helpers between jobs, and the caller for a helper's last block.
TEST(TaskRunner, WaitingThreadsSleep) {
  constexpr double kMaxLoad = 0.25;
  constexpr std::chrono::milliseconds kWait(200);
  ThreadPoolRunner runner(4);
  runner.run(4, [](std::size_t) {});
  EXPECT_LT(processor_load([&] { std::this_thread::sleep_for(kWait); }), kMaxLoad);

  const auto caller = std::this_thread::get_id();
  std::atomic<int> arrived = 0;
  const auto wait_for_helper = [&](std::size_t b) {
    if (b == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));  // worth waking someone
      return;
    }
    meet(arrived);
    if (std::this_thread::get_id() != caller) std::this_thread::sleep_for(kWait);
  };
  EXPECT_LT(processor_load([&] { runner.run(3, wait_for_helper); }), kMaxLoad);
}

}  // namespace
}  // namespace vat::task_runner_test
