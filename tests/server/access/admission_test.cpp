// Accounting of limits: token buckets of messages, the budget of all sessions, and addresses.

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "server/clients/message_meter.h"
#include "server/support/resource_budget.h"
#include "server/transport/address_counts.h"

namespace vat::test::admission_test {
namespace {

using std::chrono::milliseconds;

TEST(TokenBucket, AllowsABurstAndThenItsRate) {
  const SteadyClock::time_point start;
  TokenBucket bucket(10, 5, start);
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(bucket.take(1, start)) << i;
  EXPECT_DOUBLE_EQ(bucket.take(1, start).value().count(), 0.1);
  EXPECT_NEAR(bucket.take(1, start + milliseconds(60)).value().count(), 0.04, 1e-9);
  EXPECT_FALSE(bucket.take(1, start + milliseconds(101)));
  EXPECT_TRUE(bucket.take(1, start + milliseconds(102)));
}

TEST(TokenBucket, HoldsNoMoreThanABurst) {
  const SteadyClock::time_point start;
  TokenBucket bucket(10, 5, start);
  const auto later = start + std::chrono::hours(1);
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(bucket.take(1, later));
  EXPECT_TRUE(bucket.take(1, later));
}

// Messages larger than a burst pass occasionally, at the permitted average rate.
TEST(TokenBucket, AnExcessOverTheBurstDelaysTheNext) {
  const SteadyClock::time_point start;
  TokenBucket bucket(10, 5, start);
  EXPECT_FALSE(bucket.take(25, start));
  EXPECT_DOUBLE_EQ(bucket.take(25, start).value().count(), 2.5);
  EXPECT_TRUE(bucket.take(1, start + milliseconds(2000)));
  EXPECT_FALSE(bucket.take(25, start + milliseconds(2501)));
}

ServerLimits few_messages() {
  ServerLimits limits;
  limits.max_queries_per_second = 10;
  limits.max_controls_per_second = 20;
  limits.max_pointer_moves_per_second = 30;
  limits.max_scenes_per_second = 1;
  limits.max_reads_per_second = 5;
  limits.max_message_bytes_per_second = 1000;
  limits.burst_seconds = 2;
  limits.max_refusals_per_second = 3;
  return limits;
}

TEST(MessageMeter, EachClassHasItsOwnLimit) {
  const SteadyClock::time_point now;
  struct Expected {
    RateClass rate_class;
    const char* limit;
    int burst;
  };
  for (const auto& [rate_class, limit, burst] :
       {Expected{RateClass::query, "queries_per_second", 20},
        Expected{RateClass::control, "controls_per_second", 40},
        Expected{RateClass::pointer, "pointer_moves_per_second", 60},
        Expected{RateClass::scene, "scenes_per_second", 2},
        Expected{RateClass::read, "reads_per_second", 10}}) {
    MessageMeter meter(few_messages(), now);
    for (int i = 0; i < burst; ++i) EXPECT_FALSE(meter.count(rate_class, now)) << limit << i;
    const auto excess = meter.count(rate_class, now);
    ASSERT_TRUE(excess) << limit;
    EXPECT_EQ(excess->limit, limit);
    EXPECT_DOUBLE_EQ(excess->maximum, burst / 2.0);
    EXPECT_DOUBLE_EQ(excess->retry_after.count(), 2.0 / burst);
    EXPECT_FALSE(excess->is_flood);
    for (const auto other : {RateClass::query, RateClass::scene}) {
      if (other == rate_class) continue;
      EXPECT_FALSE(meter.count(other, now));
    }
  }
}

TEST(MessageMeter, BytesAndRefusalsAreLimited) {
  const SteadyClock::time_point now;
  MessageMeter meter(few_messages(), now);
  EXPECT_FALSE(meter.count_bytes(2000, now));
  EXPECT_EQ(meter.count_bytes(1, now)->limit, "message_bytes_per_second");
  for (int i = 1; i < 6; ++i) EXPECT_FALSE(meter.count_bytes(1, now)->is_flood) << i;
  EXPECT_TRUE(meter.count_bytes(1, now)->is_flood) << "beyond the limit of refusals";
}

TEST(ResourceBudget, ReturnsReleasedResources) {
  ResourceBudget budget({100, 50});
  {
    auto share = budget.take({60, 10});
    ASSERT_TRUE(std::holds_alternative<ResourceShare>(share));
    const auto refused = budget.take({41, 0});
    ASSERT_TRUE(std::holds_alternative<LimitExcess>(refused));
    EXPECT_EQ(std::get<LimitExcess>(refused).limit, "particles_in_all");
    EXPECT_EQ(std::get<LimitExcess>(refused).maximum, 100U);
    EXPECT_EQ(std::get<LimitExcess>(budget.take({0, 41})).limit, "springs_in_all");
    EXPECT_TRUE(std::holds_alternative<ResourceShare>(budget.take({40, 40})));
    const ResourceShare moved = std::get<ResourceShare>(std::move(share));
    EXPECT_EQ(budget.used().particles, 60U);
  }
  EXPECT_EQ(budget.used().particles, 0U);
  EXPECT_EQ(budget.used().springs, 0U);
}

TEST(ResourceBudget, ASharesChangeFitsOrChangesNothing) {
  ResourceBudget budget({100, 100});
  const ResourceShare other = budget.take_anyway({70, 0});
  ResourceShare share = budget.take_anyway({50, 0});
  EXPECT_TRUE(share.resize({51, 0}));
  EXPECT_EQ(budget.used().particles, 120U);
  EXPECT_FALSE(share.resize({45, 0})) << "a reduction always succeeds";
  EXPECT_FALSE(share.resize({30, 0}));
  EXPECT_TRUE(share.resize({31, 0}));
  EXPECT_EQ(budget.used().particles, 100U);
}

TEST(ResourceBudget, GrantsTheLastResourcesToOneOfManyRequests) {
  ResourceBudget budget({1000, 1000});
  std::atomic<int> given = 0;
  std::vector<ResourceShare> shares;
  std::mutex mutex;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t) {
      threads.emplace_back([&] {
        for (int i = 0; i < 1000; ++i) {
          auto share = budget.take({7, 3});
          if (!std::holds_alternative<ResourceShare>(share)) continue;
          ++given;
          const std::lock_guard lock(mutex);
          shares.push_back(std::get<ResourceShare>(std::move(share)));
        }
      });
    }
  }
  EXPECT_EQ(given, 1000 / 7);
  EXPECT_EQ(budget.used().particles, 1000U / 7 * 7);
}

TEST(AddressCounts, EachAddressHasItsPlaces) {
  AddressCounts counts;
  auto first = counts.take("a", 2);
  const auto second = counts.take("a", 2);
  EXPECT_NE(first, nullptr);
  EXPECT_NE(second, nullptr);
  EXPECT_EQ(counts.take("a", 2), nullptr);
  EXPECT_NE(counts.take("b", 1), nullptr);
  first.reset();
  EXPECT_NE(counts.take("a", 2), nullptr);
}

TEST(AddressCounts, APlaceMayOutliveThem) {
  AddressCounts::Place place;
  {
    AddressCounts counts;
    place = counts.take("a", 1);
  }
  place.reset();
}

}  // namespace
}  // namespace vat::test::admission_test
