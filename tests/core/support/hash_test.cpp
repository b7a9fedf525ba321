#include "core/support/hash.h"

#include <gtest/gtest.h>

namespace vat::hash_test {
namespace {

template <class... Values>
std::uint64_t hash_of(const Values&... values) {
  StateHash hash;
  (hash.add(values), ...);
  return hash.value();
}

TEST(Hash, StartsFromThePublishedOffset) {
  EXPECT_EQ(StateHash().value(), 14695981039346656037ULL);
}

// Published 64-bit FNV-1a hashes of one byte. They differ from this hash only in the final shift.
TEST(Hash, MatchesPublishedValuesOfOneByte) {
  const auto shifted = [](std::uint64_t published) { return published ^ (published >> 32); };
  EXPECT_EQ(hash_of(std::uint64_t{'a'}), shifted(0xaf63dc4c8601ec8cULL));
  EXPECT_EQ(hash_of(std::uint64_t{'b'}), shifted(0xaf63df4c8601f1a5ULL));
  EXPECT_EQ(hash_of(std::uint64_t{0}), shifted(0xaf63bd4c8601b7dfULL));
}

TEST(Hash, TakesTheBitsOfNumbers) {
  EXPECT_EQ(hash_of(1.0), hash_of(std::uint64_t{0x3ff0000000000000ULL}));
  EXPECT_NE(hash_of(0.0), hash_of(-0.0));
  EXPECT_NE(hash_of(1.0), hash_of(1.0 + 0x1p-52));
}

TEST(Hash, DependsOnTheOrder) {
  EXPECT_NE(hash_of(1.0, 2.0), hash_of(2.0, 1.0));
  EXPECT_NE(hash_of(0.0), hash_of(0.0, 0.0));
}

TEST(Hash, OfVectorsAndQuaternionsIsThatOfTheirComponents) {
  EXPECT_EQ(hash_of(Vec3(1, 2, 3)), hash_of(1.0, 2.0, 3.0));
  EXPECT_EQ(hash_of(Quat(1, 2, 3, 4)), hash_of(1.0, 2.0, 3.0, 4.0));
}

// Without the final shift, a change of a high bit would not change the low bits.
TEST(Hash, AChangeOfTheHighestBitReachesTheLowHalf) {
  const std::uint64_t a = hash_of(1.0);
  const std::uint64_t b = hash_of(-1.0);
  EXPECT_NE(a & 0xffffffff, b & 0xffffffff);
}

}  // namespace
}  // namespace vat::hash_test
