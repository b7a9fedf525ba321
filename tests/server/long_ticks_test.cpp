#include "server/session/long_ticks.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace vat::test::long_ticks_test {
namespace {

TEST(LongTicks, WhoFindsNoPlaceGetsTheFirstThatIsFree) {
  LongTicks ticks(2);
  std::vector<int> order;
  std::vector<LongTicks::Place> given;
  const auto wake = [&](int who) {
    return [&, who](LongTicks::Place place) {
      order.push_back(who);
      given.push_back(std::move(place));
    };
  };
  LongTicks::Place first = ticks.take(wake(1));
  LongTicks::Place second = ticks.take(wake(2));
  EXPECT_NE(first, nullptr);
  EXPECT_NE(second, nullptr);
  EXPECT_EQ(ticks.take(wake(3)), nullptr);
  EXPECT_EQ(ticks.take(wake(4)), nullptr);
  second.reset();
  EXPECT_EQ(order, (std::vector<int>{3}));
  EXPECT_EQ(ticks.take(wake(5)), nullptr) << "it is not the first in the line";
  first.reset();
  EXPECT_EQ(order, (std::vector<int>{3, 4}));
  std::vector<LongTicks::Place> gone = std::move(given);
  given.clear();
  gone.clear();
  EXPECT_EQ(order, (std::vector<int>{3, 4, 5}));
  EXPECT_NE(ticks.take(wake(6)), nullptr);
  given.clear();
}

TEST(LongTicks, APlaceThatNobodyTakesGoesToTheNext) {
  LongTicks ticks(1);
  LongTicks::Place place = ticks.take([](const LongTicks::Place&) {});
  bool came = false;
  ticks.take([](const LongTicks::Place&) {});  // has gone meanwhile
  ticks.take([&](const LongTicks::Place&) { came = true; });
  place.reset();
  EXPECT_TRUE(came);
}

TEST(LongTicks, NeverMoreAtOnceThanThereArePlaces) {
  constexpr int kPlaces = 3;
  LongTicks ticks(kPlaces);
  std::atomic<int> now = 0;
  std::atomic<int> most = 0;
  std::atomic<int> done = 0;
  const auto work = [&] {
    const int count = ++now;
    int seen = most;
    while (seen < count && !most.compare_exchange_weak(seen, count)) {
    }
    std::this_thread::yield();
    --now;
    ++done;
  };
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t) {
      threads.emplace_back([&] {
        for (int i = 0; i < 1000; ++i) {
          const LongTicks::Place place = ticks.take([&](const LongTicks::Place&) { work(); });
          if (place != nullptr) work();
        }
      });
    }
  }
  EXPECT_EQ(done, 8000);
  EXPECT_LE(most, kPlaces);
}

}  // namespace
}  // namespace vat::test::long_ticks_test
