#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/limits.h"
#include "tests/support/errors.h"
#include "tests/support/shaken_vat.h"

namespace vat::test::grab_test {
namespace {

constexpr Real kStep = 1e-3;
constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
constexpr Real kFrequency = 4 * std::numbers::pi;  // [rad/s] of the grab's spring
constexpr Real kMaxAcceleration = 200;             // [m/s^2] limit of the grab
constexpr std::uint64_t kHand = 17;

Simulation make_block_of(BodyKind kind, int n = 3) {
  Scene scene = make_two_material_scene(IntegratorId::runge_kutta_4, kStep);
  scene.bodies = {make_block("block", kind, "a", n, Vec3::Zero(), Vec3::Zero())};
  scene.bodies[0].angular_velocity.setZero();
  return make_simulation(scene);
}
Vec3 center_of(const Simulation& simulation) {
  return simulation.diagnostics().bodies[0].center_of_mass;
}

TEST(Grab, PullsAsACriticallyDampedSpring) {
  Simulation simulation = make_block_of(BodyKind::rigid, 1);
  const Vec3 target(0.1, -0.2, 0.3);
  ASSERT_TRUE(simulation.grab_start(kHand, simulation.bodies()[0].id, 0, target).ok());
  for (int n = 0; n < 50; ++n) {
    simulation.advance(10);
    const Real phase = kFrequency * simulation.time();
    const Vec3 expected = (1 - (1 + phase) * std::exp(-phase)) * target;
    EXPECT_LT((center_of(simulation) - expected).norm(), 1e-9);
  }
}

// In a periodic box of 1 m, a target 0.9 m ahead is 0.1 m behind.
TEST(Grab, PullsToTheNearestImageOfItsTarget) {
  Scene scene = make_two_material_scene(IntegratorId::runge_kutta_4, kStep);
  scene.periodic = Periodicity{{-0.5, -1, -1}, {0.5, 1, 1}, {true, false, false}};
  scene.bodies = {make_block("block", BodyKind::deformable, "a", 1, Vec3::Zero(), Vec3::Zero())};
  Simulation simulation = make_simulation(scene);
  ASSERT_TRUE(simulation.grab_start(kHand, simulation.bodies()[0].id, 0, {0.9, 0, 0}).ok());
  simulation.advance(100);
  const Real phase = kFrequency * simulation.time();
  EXPECT_NEAR(position_of(simulation, 0, 0).x(), -0.1 * (1 - (1 + phase) * std::exp(-phase)), 1e-9);
}

TEST(Grab, PullsNoHarderThanItsLimit) {
  Simulation simulation = make_block_of(BodyKind::rigid, 1);
  ASSERT_TRUE(simulation.grab_start(kHand, simulation.bodies()[0].id, 0, {1000, 0, 0}).ok());
  simulation.advance(10);
  EXPECT_NEAR(velocity_of(simulation, 0).x(), kMaxAcceleration * 10 * kStep, 1e-12);
}

// The grab acts on a corner, so the body also turns until that corner is at the target.
TEST(Grab, BringsEveryKindToTheTarget) {
  for (const BodyKind kind : {BodyKind::deformable, BodyKind::rigid}) {
    Simulation simulation = make_block_of(kind);
    const Vec3 target(0.2, 0.1, -0.1);
    ASSERT_TRUE(simulation.grab_start(kHand, simulation.bodies()[0].id, 0, target).ok());
    simulation.advance(3000);
    EXPECT_LT((position_of(simulation, 0, 0) - target).norm(), 1e-2) << to_string(kind);
  }
}

TEST(Grab, SharesItsForceAmongTheParticlesAround) {
  constexpr Real kReach = 0.15 + 1e-9;  // three diameters
  for (const BodyKind kind : {BodyKind::deformable, BodyKind::liquid}) {
    Simulation held = make_block_of(kind, 9);  // 0.4 m: wider than the reach
    Simulation left_alone = make_block_of(kind, 9);
    const BodyView body = held.bodies()[0];
    const std::vector<Vec3> start(body.positions.begin(), body.positions.end());
    ASSERT_TRUE(held.grab_start(kHand, body.id, 0, start[0] + Vec3(-0.1, 0, 0)).ok());
    held.advance(1);
    left_alone.advance(1);
    Real least_within = 1;
    Real greatest_beyond = 0;
    for (std::size_t i = 0; i < start.size(); ++i) {
      const Real gain = velocity_of(left_alone, 0, i).x() - velocity_of(held, 0, i).x();
      if ((start[i] - start[0]).norm() <= kReach) {
        least_within = std::min(least_within, gain);
      } else {
        greatest_beyond = std::max(greatest_beyond, gain);
      }
    }
    EXPECT_GT(least_within, 10 * greatest_beyond) << to_string(kind);
  }
}

TEST(Grab, MovesAndReleases) {
  Simulation simulation = make_block_of(BodyKind::rigid, 1);
  ASSERT_TRUE(simulation.grab_start(kHand, simulation.bodies()[0].id, 0, {0.1, 0, 0}).ok());
  simulation.advance(2000);
  ASSERT_TRUE(simulation.grab_move(kHand, {0, 0.2, 0}).ok());
  simulation.advance(2000);
  EXPECT_LT((center_of(simulation) - Vec3(0, 0.2, 0)).norm(), 1e-6);
  ASSERT_TRUE(simulation.grab_move(kHand, {0, 0, 0.3}).ok());
  simulation.advance(50);
  ASSERT_TRUE(simulation.grab_end(kHand).ok());
  const Vec3 velocity = velocity_of(simulation, 0);
  EXPECT_GT(velocity.norm(), 0.1);
  simulation.advance(100);
  EXPECT_EQ(velocity_of(simulation, 0), velocity);
}

TEST(Grab, ReportsItsTargetAfterARestore) {
  Simulation simulation = make_block_of(BodyKind::rigid, 1);
  EXPECT_EQ(simulation.grab_target(kHand), std::nullopt);
  ASSERT_TRUE(simulation.grab_start(kHand, simulation.bodies()[0].id, 0, {0.1, 0, 0}).ok());
  const Snapshot before = simulation.snapshot();
  ASSERT_TRUE(simulation.grab_move(kHand, {0, 0.2, 0}).ok());
  EXPECT_EQ(simulation.grab_target(kHand), Vec3(0, 0.2, 0));
  simulation.restore(before);
  EXPECT_EQ(simulation.grab_target(kHand), Vec3(0.1, 0, 0));
  ASSERT_TRUE(simulation.grab_end(kHand).ok());
  EXPECT_EQ(simulation.grab_target(kHand), std::nullopt);
}

TEST(Grab, StartedAgainMovesToTheNewBody) {
  Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, kStep);
  scene.bodies = {make_block("one", BodyKind::rigid, "a", 1, {0, 0, 0}, Vec3::Zero()),
                  make_block("two", BodyKind::rigid, "a", 1, {1, 0, 0}, Vec3::Zero())};
  Simulation simulation = make_simulation(scene);
  const std::vector<BodyView> bodies = simulation.bodies();
  ASSERT_TRUE(simulation.grab_start(kHand, bodies[0].id, 0, {0, 1, 0}).ok());
  ASSERT_TRUE(simulation.grab_start(kHand, bodies[1].id, 0, {1, 1, 0}).ok());
  simulation.advance(100);
  EXPECT_EQ(position_of(simulation, 0), Vec3(0, 0, 0));
  EXPECT_GT(position_of(simulation, 1).y(), 0.1);
}

TEST(Grab, FollowsItsBodyWhenAnotherIsRemoved) {
  Simulation simulation = make_simulation(make_shaken_vat(IntegratorId::velocity_verlet));
  const BodyId crate = simulation.find_body("crate").value();
  ASSERT_TRUE(simulation.grab_start(kHand, crate, 0, {0, 0, 0.8}).ok());
  ASSERT_TRUE(simulation.remove_body(simulation.find_body("pool").value()).ok());
  simulation.advance(1000);
  EXPECT_GT(simulation.find_body(crate)->positions[0].z(), 0.7);
}

TEST(Grab, RefusesBadValues) {
  Simulation simulation = make_block_of(BodyKind::rigid);
  const BodyId id = simulation.bodies()[0].id;
  EXPECT_EQ(errors_of(simulation.grab_start(kHand, id + 1, 0, {})), "no_such_body /body");
  EXPECT_EQ(errors_of(simulation.grab_start(kHand, id, 27, Vec3::Zero())),
            "out_of_range /particle");
  EXPECT_EQ(errors_of(simulation.grab_start(kHand, id, 0, {0, kNan, 0})), "out_of_range /target");
  EXPECT_EQ(errors_of(simulation.grab_move(kHand, Vec3::Zero())), "no_such_grab /grab");
  EXPECT_EQ(errors_of(simulation.grab_end(kHand)), "no_such_grab /grab");
  for (std::uint64_t n = 0; n < kMaxGrabs; ++n) {
    ASSERT_TRUE(simulation.grab_start(n, id, 0, Vec3::Zero()).ok());
  }
  EXPECT_EQ(errors_of(simulation.grab_start(kMaxGrabs, id, 0, Vec3::Zero())), "limit_reached ");
  EXPECT_EQ(errors_of(simulation.grab_start(0, id, 1, Vec3::Zero())), "");
  EXPECT_EQ(errors_of(simulation.grab_move(0, {kNan, 0, 0})), "out_of_range /target");
}

}  // namespace
}  // namespace vat::test::grab_test
