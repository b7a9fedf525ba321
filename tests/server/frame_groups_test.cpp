#include "server/session/frame_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vat::frame_groups_test {
namespace {

using testing::ElementsAre;
using testing::UnorderedElementsAre;

TEST(FrameGroups, AllWhereThereAreFew) {
  EXPECT_THAT(choose_groups({}, 8), ElementsAre());
  const std::vector<GroupClaim> claims = {{1, 0}, {5, 0}, {3, 9}};
  EXPECT_THAT(choose_groups(claims, 3), ElementsAre(1, 2, 0)) << "the largest first";
}

TEST(FrameGroups, HalfForTheLargestAndHalfForWhoHasWaited) {
  const std::vector<GroupClaim> claims = {{100, 0}, {1, 7}, {50, 0}, {2, 1}, {40, 0}, {1, 8}};
  EXPECT_THAT(choose_groups(claims, 4), UnorderedElementsAre(0, 2, 5, 1));
}

TEST(FrameGroups, OfThoseWhoHaveWaitedAlikeTheLarger) {
  const std::vector<GroupClaim> claims = {{9, 0}, {1, 2}, {3, 2}, {2, 2}};
  EXPECT_THAT(choose_groups(claims, 2), UnorderedElementsAre(0, 2));
}

}  // namespace
}  // namespace vat::frame_groups_test
