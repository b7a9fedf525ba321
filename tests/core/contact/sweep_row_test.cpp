#include "core/contact/projection/sweep_row.h"

#include <gtest/gtest.h>

#include "core/contact/projection/cross_matrix.h"

namespace vat::sweep_row_test {
namespace {

constexpr Real kStep = 0.01;  // [s]

/// An end of a contact at the origin.
struct End {
  Vec3 velocity = Vec3::Zero();
  Vec3 spin = Vec3::Zero();
  Vec3 center = Vec3::Zero();
  Real mass = 1;
  Mat3 inertia = Mat3::Identity();
  Mat3 inverse_inertia = Mat3::Identity();
  bool turns = false;

  SweepRow::Side side() {
    SweepRow::Side side{.velocity = &velocity, .inverse_mass = 1 / mass};
    if (!turns) return side;
    inverse_inertia = inertia.inverse();
    side.spin = &spin;
    side.inverse_inertia = &inverse_inertia;
    side.arm = side.late_arm = -center;
    return side;
  }
  Mat3 mobility() const {
    Mat3 sum = Mat3::Identity() / mass;
    if (turns) sum -= cross_matrix(center) * inertia.inverse() * cross_matrix(center);
    return sum;
  }
  Vec3 momentum() const { return mass * velocity; }
  Vec3 angular_momentum() const {
    return center.cross(momentum()) + (turns ? Vec3(inertia * spin) : Vec3(Vec3::Zero()));
  }
};

SweepRow make_row(End& first, End* second, Real friction) {
  SweepRow row{.sides = {first.side(), second != nullptr ? second->side() : SweepRow::Side{}},
               .normal = Vec3(1, 2, 2) / 3,
               .mobility = first.mobility(),
               .normal_mobility = Vec3::Zero(),
               .inverse_mobility = 0,
               .scale = 1,
               .friction = friction,
               .dt = kStep,
               .push = 0,
               .friction_impulse = Vec3::Zero(),
               .gradient = Vec3::Zero()};
  if (second != nullptr) row.mobility += second->mobility();
  row.normal_mobility = row.mobility * row.normal;
  row.inverse_mobility = 1 / row.normal.dot(row.normal_mobility);
  return row;
}

const Vec3 kAcross = Vec3(2, -2, 1) / 3;  // perpendicular to the normal

TEST(SweepRow, StopsAParticleAtAMovingWallAndSlowsItByFriction) {
  End end{.mass = 2};
  SweepRow row = make_row(end, nullptr, 0.5);
  row.wall_velocity = 0.25 * row.normal;
  end.velocity = -0.75 * row.normal + 3 * kAcross;
  EXPECT_NEAR(row.relax(), 2, 1e-14);  // a push of 2 kg * 1 m/s
  EXPECT_NEAR(row.push, 2, 1e-14);
  EXPECT_NEAR((row.friction_impulse + 1 * kAcross).norm(), 0, 1e-14);  // 0.5 of the push
  EXPECT_NEAR((end.velocity - (0.25 * row.normal + 2.5 * kAcross)).norm(), 0, 1e-14);
  EXPECT_NEAR(row.relax(), 0, 1e-14);
}

TEST(SweepRow, SticksIfFrictionSuffices) {
  End end{.mass = 2};
  SweepRow row = make_row(end, nullptr, 0.5);
  end.velocity = -row.normal + 0.4 * kAcross;
  row.relax();
  EXPECT_NEAR(end.velocity.norm(), 0, 1e-15);
}

TEST(SweepRow, ReleasesAnImpulseThatPulls) {
  End end{.mass = 2};
  SweepRow row = make_row(end, nullptr, 0.5);
  row.push = 1;
  row.friction_impulse = 0.3 * kAcross;
  end.velocity = 4 * row.normal;
  row.relax();
  EXPECT_EQ(row.push, 0);
  EXPECT_EQ(row.friction_impulse.norm(), 0);
  EXPECT_NEAR((end.velocity - (3.5 * row.normal - 0.15 * kAcross)).norm(), 0, 1e-15);
}

// Two bodies that turn. Impulses act at one point, so that both momenta are conserved.
TEST(SweepRow, StopsTheSlipOfTurningBodiesAndKeepsTheirMomenta) {
  End first{.velocity = {0.3, -0.2, 0.1},
            .spin = {1, 2, -1},
            .center = {0.3, 0.1, 0.5},
            .mass = 2,
            .inertia = Vec3(0.1, 0.2, 0.3).asDiagonal(),
            .turns = true};
  End second{.velocity = {1, 1.5, 2},
             .spin = {-1, 0.5, 3},
             .center = {-0.2, -0.3, -0.1},
             .mass = 3,
             .inertia = Vec3(0.3, 0.1, 0.2).asDiagonal(),
             .turns = true};
  SweepRow row = make_row(first, &second, 100);
  const Vec3 momentum = first.momentum() + second.momentum();
  const Vec3 angular_momentum = first.angular_momentum() + second.angular_momentum();
  EXPECT_LT(row.excess(row.slip()), 0);
  for (int n = 0; n < 100; ++n) row.relax();
  EXPECT_NEAR(row.slip().norm(), 0, 1e-12);
  EXPECT_GT(row.push, 0);
  EXPECT_NEAR((first.momentum() + second.momentum() - momentum).norm(), 0, 1e-13);
  EXPECT_NEAR((first.angular_momentum() + second.angular_momentum() - angular_momentum).norm(), 0,
              1e-13);
}

// The distance at the end of the step is the required one, although it is not linear in the
// velocities.
TEST(SweepRow, ClosesTheGapBetweenEndsAtTheEndOfTheStep) {
  End first{.velocity = {-5, -4, 0}, .mass = 2};
  End second{.velocity = {2, 0, 5}, .mass = 3};
  SweepRow row = make_row(first, &second, 0);
  row.kind = SweepRow::Excess::gap;
  row.start = 0.3 * row.normal;
  row.required = 0.25;
  const auto distance = [&] {
    return (row.start + kStep * (first.velocity - second.velocity)).norm();
  };
  ASSERT_LT(distance(), row.required);
  for (int n = 0; n < 100; ++n) row.relax();
  EXPECT_NEAR(distance(), row.required, 1e-14);
}

TEST(SweepRow, ClosesTheGapToAWallAtTheEndOfTheStep) {
  End end{.velocity = {-30, 4, 0}};
  SweepRow row = make_row(end, nullptr, 0);
  row.kind = SweepRow::Excess::wall_gap;
  row.start = 0.06 * row.normal;
  row.required = 0.05;
  row.relax();
  EXPECT_NEAR((row.start + kStep * end.velocity).dot(row.normal), 0.05, 1e-15);
}

}  // namespace
}  // namespace vat::sweep_row_test
