#include "server/clock.h"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>

#include "server/session/deferred_tasks.h"
#include "tests/support/manual_clock.h"

namespace vat::test::clock_test {
namespace {

using namespace std::chrono_literals;

// The context ends when no timer is waiting any more.
TEST(SystemClock, TimersRunTheirTaskOnceAndInTime) {
  boost::asio::io_context io;
  SystemClock clock;
  const auto timer = clock.make_timer(io.get_executor());
  const auto due = clock.now() + 5ms;
  int runs = 0;
  timer->start(due, [&] {
    ++runs;
    EXPECT_GE(clock.now(), due);
  });
  io.run();
  EXPECT_EQ(runs, 1);
}

TEST(SystemClock, AStartReplacesTheTaskAndACancelDropsIt) {
  boost::asio::io_context io;
  SystemClock clock;
  const auto timer = clock.make_timer(io.get_executor());
  const auto other = clock.make_timer(io.get_executor());
  std::string runs;
  timer->start(clock.now() + 24h, [&] { runs += "a"; });
  timer->start(clock.now(), [&] { runs += "b"; });
  other->start(clock.now() + 24h, [&] { runs += "c"; });
  other->cancel();
  io.run();
  EXPECT_EQ(runs, "b");
}

TEST(SystemClock, WallTimeIsThatOfTheSystem) {
  const auto seconds = [] {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch())
        .count();
  };
  const double before = seconds();
  const double told = SystemClock().wall_time();
  EXPECT_LE(before, told);
  EXPECT_LE(told, seconds());
}

class DeferredTasksTest : public testing::Test {
 protected:
  ~DeferredTasksTest() override {
    tasks->stop();
    pool.join();
  }
  void add(SteadyClock::duration after, const std::string& name) {
    tasks->add(clock.now() + after, [this, name] { runs += name; });
  }

  ManualClock clock;
  boost::asio::thread_pool pool{2};
  const std::shared_ptr<DeferredTasks> tasks = std::make_shared<DeferredTasks>(pool, clock);
  std::string runs;
};

TEST_F(DeferredTasksTest, RunInTheOrderOfTheirTimes) {
  add(20ms, "c");
  add(10ms, "a");
  add(10ms, "b");
  add(30ms, "d");
  clock.advance(9ms);
  EXPECT_EQ(runs, "");
  clock.advance(1ms);
  EXPECT_EQ(runs, "ab");
  clock.advance(1h);
  EXPECT_EQ(runs, "abcd");
}

TEST_F(DeferredTasksTest, ATaskThatThrowsHoldsUpNoOther) {
  tasks->add(clock.now() + 1ms, [] { throw std::runtime_error("a fault"); });
  add(1ms, "a");
  add(2ms, "b");
  clock.advance(2ms);
  EXPECT_EQ(runs, "ab");
}

TEST_F(DeferredTasksTest, NoneRunsAfterTheStop) {
  add(10ms, "a");
  tasks->stop();
  add(10ms, "b");
  clock.advance(1h);
  EXPECT_EQ(runs, "");
  EXPECT_EQ(clock.waiting(), 0U);
}

}  // namespace
}  // namespace vat::test::clock_test
