#include "core/contact/projection/contact_row.h"

#include <gtest/gtest.h>

namespace vat::contact_row_test {
namespace {

constexpr Real kWeight = 4;  // [kg]

ContactRow make_row(Real friction) {
  return {.contact = 0,
          .sides = {},
          .normal = Vec3(1, 2, 2) / 3,
          .slip = Vec3::Zero(),
          .mass = 1,
          .weight = kWeight,
          .friction = friction,
          .lift = 0,
          .has_limit = false,
          .limit = 0,
          .scale = 1,
          .multiplier = Vec3::Zero(),
          .at = Vec3::Zero(),
          .turn = Vec3::Zero(),
          .impulse = Vec3::Zero()};
}

const Vec3 kAcross = Vec3(2, -2, 1) / 3;  // perpendicular to the normal

struct Case {
  const char* name;
  Real friction;
  bool has_limit;
  Real push, across;     ///< impulse before the projection [N s]
  Real expected_push;    ///< [N s]
  Real expected_across;  ///< [N s]
};

// The projections on the cone minimise the distance: (1, 3) on the edge (1, 0.5) / sqrt(1.25), ...
const Case kCases[] = {
    {"sticks", 0.5, false, 2, 0.9, 2, 0.9},
    {"slides", 0.5, false, 1, 3, 2, 1},
    {"slides under tension", 0.5, false, -1, 4, 0.8, 0.4},
    {"separates", 0.5, false, -2, 3, 0, 0},
    {"has no friction", 0, false, 2, 3, 2, 0},
    {"has no friction and separates", 0, false, -2, 3, 0, 0},
    {"sticks below its limit", 0.5, true, 2, 0.6, 2, 0.6},
    {"slides at its limit", 0.5, true, 2, 3, 2, 0.7},
    {"separates, but slides at its limit", 0.5, true, -2, 3, 0, 0.7},
};

TEST(ContactRow, ProjectsTheImpulseOnTheLaw) {
  for (const Case& c : kCases) {
    SCOPED_TRACE(c.name);
    ContactRow row = make_row(c.friction);
    row.has_limit = c.has_limit;
    row.limit = 0.7;
    row.multiplier = Vec3(0.3, 0.1, -0.2);
    const Vec3 slip = (row.multiplier - c.push * row.normal - c.across * kAcross) / kWeight;
    const Vec3 expected = c.expected_push * row.normal + c.expected_across * kAcross;
    EXPECT_LT((impulse_at(row, slip) - expected).norm(), 1e-14);
  }
}

// The second derivative of the impulse is at most weight^2 / |across|, below 20 kg^2 / (N s) here.
TEST(ContactRow, HasTheSlopeOfItsImpulse) {
  constexpr Real kStep = 1e-6;  // [m/s]
  for (const Case& c : kCases) {
    SCOPED_TRACE(c.name);
    ContactRow row = make_row(c.friction);
    row.has_limit = c.has_limit;
    row.limit = 0.7;
    const Vec3 slip = -(c.push * row.normal + c.across * kAcross) / kWeight;
    const Mat3 slope = slope_at(row, slip);
    EXPECT_LT((slope - slope.transpose()).norm(), 1e-14);
    for (int k = 0; k < 3; ++k) {
      const Vec3 step = kStep * Vec3::Unit(k);
      const Vec3 change = impulse_at(row, slip - step) - impulse_at(row, slip + step);
      EXPECT_LT((change / (2 * kStep) - slope.col(k)).norm(), 1e-8);
    }
  }
}

// A block of 1 kg on a floor gets the push 2 N s and slides with 3 m/s.
TEST(ContactRow, BecomesCoulombsLaw) {
  for (const bool has_limit : {false, true}) {
    ContactRow row = make_row(0.5);
    row.has_limit = has_limit;
    row.limit = 1;
    row.multiplier = 2 * row.normal - 1 * kAcross;
    row.slip = 3 * kAcross;
    row.lift = has_limit ? 0 : 1.5;
    EXPECT_LT(update(row), 1e-14);
    EXPECT_LT((row.multiplier - (2 * row.normal - 1 * kAcross)).norm(), 1e-14);
  }
}

TEST(ContactRow, UpdatesLiftAndLimit) {
  ContactRow row = make_row(0.5);
  row.slip = 3 * kAcross - row.normal;
  row.multiplier = 2 * row.normal;
  const Vec3 impulse = impulse_at(row, row.slip);
  EXPECT_NEAR(update(row), (impulse - 2 * row.normal).norm() / kWeight + 1.5, 1e-14);
  EXPECT_EQ(row.multiplier, impulse);
  EXPECT_NEAR(row.lift, 1.5, 1e-14);
  ContactRow limited = make_row(0.5);
  limited.has_limit = true;
  limited.slip = -row.normal;
  EXPECT_NEAR(update(limited), 1, 1e-14);
  EXPECT_NEAR(limited.limit, 0.5 * kWeight, 1e-14);
}

}  // namespace
}  // namespace vat::contact_row_test
