#include "core/support/parallel.h"

#include <gtest/gtest.h>

#include <mutex>
#include <set>

#include "tests/support/thread_runner.h"

namespace vat::test::parallel_test {
namespace {

using Range = std::pair<std::size_t, std::size_t>;

std::set<Range> ranges_of(TaskRunner* runner, std::size_t count) {
  std::mutex mutex;
  std::set<Range> ranges;
  for_blocks(runner, count, [&](std::size_t begin, std::size_t end) {
    const std::lock_guard lock(mutex);
    EXPECT_TRUE(ranges.insert({begin, end}).second) << begin;
  });
  return ranges;
}

TEST(Parallel, BlocksCoverTheRangeOnce) {
  for (const std::size_t count : {0ul, 1ul, kBlockSize - 1, kBlockSize, kBlockSize + 1, 5000ul}) {
    std::size_t next = 0;
    for (const Range& range : ranges_of(nullptr, count)) {
      EXPECT_EQ(range.first, next);
      EXPECT_LE(range.second - range.first, kBlockSize);
      next = range.second;
    }
    EXPECT_EQ(next, count);
  }
}

TEST(Parallel, BlocksAreTheSameForAnyNumberOfThreads) {
  for (const std::size_t count : {1ul, kBlockSize, kBlockSize + 1, 5000ul}) {
    const std::set<Range> serial = ranges_of(nullptr, count);
    for (const std::size_t threads : {1ul, 2ul, 3ul, 4ul}) {
      ThreadRunner runner(threads);
      EXPECT_EQ(ranges_of(&runner, count), serial) << threads << " threads";
    }
  }
}

TEST(Parallel, ASingleBlockStaysOnTheCallersThread) {
  ThreadRunner runner(4);
  ranges_of(&runner, kBlockSize);
  EXPECT_EQ(runner.runs(), 0U);
  ranges_of(&runner, kBlockSize + 1);
  EXPECT_EQ(runner.runs(), 1U);
}

}  // namespace
}  // namespace vat::test::parallel_test
