#include <gtest/gtest.h>

#include "tests/support/name_of.h"
#include "tests/support/scenes.h"

/// Rigid bodies that are fixed permanently or until a given time.
namespace vat::test::held_body_test {
namespace {

constexpr Real kGravity = 10;
constexpr Real kStep = 0.01;

BodyDescription plate(const char* name, const Vec3& position) {
  BodyDescription body = make_body(name, BodyKind::rigid, "wood",
                                   make_particles(make_lattice(3, 3, 1, 0.1), 0.1), 0.05);
  body.position = position;
  body.orientation = Quat(0.8, 0, 0, 0.6);
  return body;
}

Scene scene_of(IntegratorId integrator, std::vector<BodyDescription> bodies) {
  Scene scene = make_scene(integrator, kStep);
  scene.gravity = {0, 0, -kGravity};
  scene.materials = {make_material("wood")};
  scene.default_interface = {500, 1};
  scene.bodies = std::move(bodies);
  return scene;
}

bool same_pose(const BodyView& a, const BodyView& b) {
  return a.pose->center_of_mass == b.pose->center_of_mass &&
         a.pose->orientation.coeffs() == b.pose->orientation.coeffs() &&
         a.pose->velocity == b.pose->velocity &&
         a.pose->angular_velocity == b.pose->angular_velocity;
}

class HeldBody : public testing::TestWithParam<IntegratorId> {};

TEST_P(HeldBody, AtRestKeepsItsBitsUnderForcesAndStopsFallingBodies) {
  BodyDescription table = plate("table", {0, 0, 0});
  table.fixed = true;
  BodyDescription ball = plate("ball", {0, 0, 0.2});
  ball.velocity = {0, 0, -0.5};
  Simulation simulation = make_simulation(scene_of(GetParam(), {table, ball}));
  const Simulation first = make_simulation(scene_of(GetParam(), {table, ball}));
  const BodyId id = simulation.bodies()[0].id;
  ASSERT_TRUE(simulation.grab_start(1, id, 0, {1, 1, 1}));
  ASSERT_TRUE(simulation.apply_force(id, {5, 0, 0}, 1));
  Real lowest = 1;
  for (int step = 0; step < 60; ++step) {
    ASSERT_TRUE(simulation.advance(1).events.empty());
    lowest = std::min(lowest, simulation.bodies()[1].pose->center_of_mass.z());
    ASSERT_TRUE(same_pose(simulation.bodies()[0], first.bodies()[0])) << step;
  }
  EXPECT_GT(lowest, 0);     // it did not fall through
  EXPECT_LT(lowest, 0.15);  // it touched the obstacle
}

TEST_P(HeldBody, MovesOnAsIfNoForceActed) {
  BodyDescription body = plate("body", {0, 0, 0});
  body.fixed = true;
  body.velocity = {1, 0.5, 0.25};
  body.angular_velocity = {0.5, -1, 2};
  Simulation simulation = make_simulation(scene_of(GetParam(), {body}));
  const BodyDiagnostics before = simulation.diagnostics().bodies[0];
  advance_to(simulation, 1);
  const BodyDiagnostics after = simulation.diagnostics().bodies[0];
  EXPECT_EQ(after.linear_momentum, before.linear_momentum);
  EXPECT_LT((after.center_of_mass - before.center_of_mass - body.velocity).norm(), 1e-12);
  EXPECT_LT((after.angular_momentum - after.center_of_mass.cross(after.linear_momentum) -
             before.angular_momentum + before.center_of_mass.cross(before.linear_momentum))
                .norm(),
            1e-14);
}

/// Under constant gravity every integrator's velocity is exact.
Real fallen_speed(const Simulation& simulation) {
  return -simulation.bodies()[0].pose->velocity.z() / kGravity;
}

TEST_P(HeldBody, IsFreeFromTheFirstStepThatBeginsAtItsRelease) {
  for (const Real release : {0.05, 0.041}) {
    BodyDescription body = plate("body", {0, 0, 0});
    body.release = release;
    Simulation simulation = make_advanced(scene_of(GetParam(), {body}), 5);
    EXPECT_EQ(fallen_speed(simulation), 0) << release;
    simulation.advance(1);
    EXPECT_NEAR(fallen_speed(simulation), kStep, 1e-15) << release;
    simulation.advance(4);
    EXPECT_NEAR(fallen_speed(simulation), 5 * kStep, 1e-15) << release;
  }
}

TEST(HeldBodyState, ASnapshotBeforeTheReleaseContinuesWithTheSameBits) {
  BodyDescription body = plate("body", {0, 0, 0});
  body.release = 0.05;
  Simulation simulation = make_advanced(scene_of(IntegratorId::velocity_verlet, {body}), 3);
  const Snapshot snapshot = simulation.snapshot();
  simulation.advance(10);
  const auto hash = simulation.state_hash();
  simulation.restore(snapshot);
  simulation.advance(10);
  EXPECT_EQ(simulation.state_hash(), hash);
}

INSTANTIATE_TEST_SUITE_P(Integrators, HeldBody, testing::ValuesIn(kIntegrators), NameOf());

}  // namespace
}  // namespace vat::test::held_body_test
