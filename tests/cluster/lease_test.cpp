#include "server/cluster/lease.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/support/manual_clock.h"

namespace vat::test::lease_test {
namespace {

using std::chrono::milliseconds;

class LeaseTest : public testing::Test {
 protected:
  /// Enters as a new node does.
  void enter() {
    lease.confirm(clock.now());
    ASSERT_TRUE(lease.reopen(clock.now()));
  }

  ManualClock clock;
  Lease lease{clock};
};

TEST_F(LeaseTest, ANewNodeHasNoLeaseUntilItHasCheckedItsSessions) {
  EXPECT_FALSE(lease.is_valid());
  EXPECT_FALSE(lease.confirm(clock.now()));
  EXPECT_FALSE(lease.is_valid());
  EXPECT_TRUE(lease.reopen(clock.now()));
  EXPECT_TRUE(lease.is_valid());
}

TEST_F(LeaseTest, EndsTheHoldersTimeAfterTheRenewalWasSent) {
  enter();
  const auto sent = clock.now();
  clock.advance(milliseconds(1500));
  EXPECT_TRUE(lease.confirm(sent));  // a late confirmation does not prolong it
  clock.advance(milliseconds(499));
  EXPECT_TRUE(lease.is_valid());
  clock.advance(milliseconds(1));
  EXPECT_FALSE(lease.is_valid());
  EXPECT_LT(Lease::kHolderTime, Lease::kOthersTime);
}

TEST_F(LeaseTest, AConfirmationAfterItsEndDoesNotRestoreIt) {
  enter();
  clock.advance(milliseconds(10'000));
  const auto sent = clock.now();
  EXPECT_FALSE(lease.confirm(sent));
  EXPECT_FALSE(lease.is_valid());
  EXPECT_TRUE(lease.reopen(sent));
  EXPECT_TRUE(lease.is_valid());
  EXPECT_EQ(lease.held_since(), sent);
}

TEST_F(LeaseTest, ACheckOfSessionsThatTookTooLongDoesNotRestoreIt) {
  const auto sent = clock.now();
  lease.confirm(sent);
  clock.advance(milliseconds(2000));  // a suspended process, for example
  lease.confirm(clock.now());
  EXPECT_FALSE(lease.reopen(sent));
  EXPECT_FALSE(lease.is_valid());
}

TEST_F(LeaseTest, IsRenewedTwiceInTheHoldersTimeByTheNodesOfAnyCluster) {
  for (const auto& [nodes, interval] : std::vector<std::pair<std::size_t, int>>{
           {0, 500}, {100, 500}, {150, 750}, {200, 1000}, {1'000'000, 1000}}) {
    EXPECT_EQ(Lease::renewal_interval(nodes), milliseconds(interval)) << nodes;
    EXPECT_LE(2 * Lease::renewal_interval(nodes), Lease::kHolderTime) << nodes;
  }
}

}  // namespace
}  // namespace vat::test::lease_test
