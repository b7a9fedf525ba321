#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/state/rigid_motion.h"
#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"

namespace vat::test::rigid_test {
namespace {

/// An L of three particles with different masses, rotated and moved.
Scene make_rigid_scene() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3, {make_material("wood")});
  ParticleShape shape = make_particles({{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}, 1);
  shape.masses = {1, 2, 3};
  scene.bodies = {make_body("ell", BodyKind::rigid, "wood", shape, 0.1)};
  scene.bodies[0].position = {5, 6, 7};
  scene.bodies[0].orientation = Quat(Eigen::AngleAxis<Real>(std::numbers::pi / 2, Vec3::UnitZ()));
  scene.bodies[0].velocity = {1, 0, 0};
  scene.bodies[0].angular_velocity = {0, 0, 2};
  return scene;
}

TEST(Rigid, StartsAtItsPlaceWithItsVelocities) {
  const Simulation simulation = make_simulation(make_rigid_scene());
  const BodyView body = simulation.bodies()[0];
  // A quarter turn about z maps (x, y) to (-y, x).
  EXPECT_LT((body.positions[0] - Vec3(5, 6, 7)).norm(), 1e-14);
  EXPECT_LT((body.positions[1] - Vec3(5, 7, 7)).norm(), 1e-14);
  EXPECT_LT((body.positions[2] - Vec3(3, 6, 7)).norm(), 1e-14);
  const Vec3 center = (body.positions[0] + 2 * body.positions[1] + 3 * body.positions[2]) / 6;
  ASSERT_TRUE(body.pose);
  EXPECT_LT((body.pose->center_of_mass - center).norm(), 1e-14);
  EXPECT_LT((body.pose->velocity - Vec3(1, 0, 0)).norm(), 1e-14);
  EXPECT_LT((body.pose->angular_velocity - Vec3(0, 0, 2)).norm(), 1e-13);
  const Vec3 places[] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};  // in the shape
  ASSERT_EQ(body.local_positions.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 arm = body.positions[i] - body.pose->center_of_mass;
    EXPECT_LT((body.velocities[i] - Vec3(1 - 2 * arm.y(), 2 * arm.x(), 0)).norm(), 1e-13);
    EXPECT_LT((body.local_positions[i] - (places[i] - Vec3(2.0 / 6, 1, 0))).norm(), 1e-14);
  }
}

TEST(Rigid, KeepsItsShape) {
  Scene scene = make_rigid_scene();
  for (const IntegratorId integrator : kIntegrators) {
    scene.numerics.integrator = integrator;
    Simulation simulation = make_advanced(scene, 2000);
    const BodyView body = simulation.bodies()[0];
    EXPECT_NEAR((body.positions[0] - body.positions[1]).norm(), 1, 1e-13);
    EXPECT_NEAR((body.positions[0] - body.positions[2]).norm(), 2, 1e-13);
    EXPECT_NEAR((body.positions[1] - body.positions[2]).norm(), std::sqrt(5.0), 1e-13);
    EXPECT_NEAR(body.pose->orientation.norm(), 1, 1e-15);
  }
}

TEST(Rigid, GathersForceAndTorque) {
  Scene scene = make_rigid_scene();
  scene.gravity = {0, 0, -10};
  scene.vat = Vat{Vec3::Constant(-100), Vec3::Constant(100), false, {}};
  scene.vat->min.z() = 6.95;
  scene.default_interface = {1000, 0};
  const BodyDescription& body = scene.bodies[0];
  const Vec3 push = 1000 * 0.05 * Vec3::UnitZ();  // radius 0.1, height 0.05, on each of the three
  const Vec3 center = body.position + body.orientation * Vec3(2.0 / 6, 1, 0);
  Vec3 torque = Vec3::Zero();
  for (const Vec3& p : std::get<ParticleShape>(body.shape).positions) {
    torque += (body.position + body.orientation * p - center).cross(push);
  }
  ForceProbe probe(scene);
  const Forces& forces = probe.state().forces;
  EXPECT_LT((forces.rigid_force[0] - Vec3(0, 0, 150 - 60)).norm(), 1e-10);
  EXPECT_LT((forces.rigid_torque[0] - torque).norm(), 1e-10);
  EXPECT_GT(torque.norm(), 1);
}

TEST(Rigid, OrientationRateIsHalfOmegaTimesQ) {
  // Rotation about z at rate w: q = (cos wt/2, 0, 0, sin wt/2).
  const Real w = 3;
  const Real t = 0.4;
  const Quat q(std::cos(w * t / 2), 0, 0, std::sin(w * t / 2));
  const Quat rate = orientation_rate(q, {0, 0, w});
  EXPECT_NEAR(rate.w(), -w / 2 * std::sin(w * t / 2), 1e-15);
  EXPECT_NEAR(rate.z(), w / 2 * std::cos(w * t / 2), 1e-15);
  EXPECT_EQ(rate.x(), 0);
  EXPECT_EQ(rate.y(), 0);
}

TEST(Rigid, AngularVelocityUsesTheInertiaInWorldAxes) {
  RigidModel rigid;
  rigid.inertia = Vec3(2, 3, 4).asDiagonal();
  rigid.inverse_inertia = rigid.inertia.inverse();
  EXPECT_LT((angular_velocity(rigid, Quat::Identity(), {2, 3, 4}) - Vec3(1, 1, 1)).norm(), 1e-15);
  const Quat quarter(Eigen::AngleAxis<Real>(std::numbers::pi / 2, Vec3::UnitZ()));
  // The body's x axis is along the world's y axis: I_world = diag(3, 2, 4).
  EXPECT_LT((angular_velocity(rigid, quarter, {3, 2, 4}) - Vec3(1, 1, 1)).norm(), 1e-15);
}

/// A body with the moments 2, 3 and 4 about x, y and z.
RigidModel make_unequal_body() {
  RigidModel rigid;
  rigid.inertia = Vec3(2, 3, 4).asDiagonal();
  rigid.inverse_inertia = rigid.inertia.inverse();
  rigid.principal_axes = Quat::Identity();
  rigid.inverse_moments = rigid.inverse_inertia.diagonal();
  rigid.splitting = {1, 2, 0};
  return rigid;
}

Quat rotate_for_a_second(const Vec3& angular_momentum, int steps) {
  Quat q = Quat::Identity();
  for (int s = 0; s < steps; ++s) {
    q = rotate_freely(make_unequal_body(), q, angular_momentum, 1.0 / steps);
  }
  return q;
}

// The reverse rotations in the opposite order restore the start.
TEST(Rigid, FreeRotationIsReversible) {
  const RigidModel rigid = make_unequal_body();
  const Vec3 angular_momentum(6, 5, 4);
  const Quat there = rotate_freely(rigid, Quat::Identity(), angular_momentum, 0.5);
  EXPECT_GT(there.angularDistance(Quat::Identity()), 0.5);
  const Quat back = rotate_freely(rigid, there, angular_momentum, -0.5);
  EXPECT_LT(back.angularDistance(Quat::Identity()), 1e-14);
}

TEST(Rigid, FreeRotationIsOfOrderFour) {
  const Vec3 angular_momentum(6, 5, 4);
  const Quat exact =
      rotate_for_a_second(angular_momentum, 1024);  // the error is 2^-24 of that with 16 steps
  const auto error_of = [&](int steps) {
    return rotate_for_a_second(angular_momentum, steps).angularDistance(exact);
  };
  EXPECT_NEAR(std::log2(error_of(8) / error_of(16)), 4, 0.2);
}

TEST(Rigid, ASingleParticleSpinsAsASphere) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-2, {make_material("steel")});
  scene.bodies = {make_body("bead", BodyKind::rigid, "steel", make_particles({{1, 0, 0}}, 3), 0.5)};
  scene.bodies[0].angular_velocity = {1, 2, 3};
  Simulation simulation = make_simulation(scene);
  const Diagnostics diagnostics = simulation.diagnostics();
  EXPECT_NEAR(diagnostics.kinetic_energy, 0.5 * 0.4 * 3 * 0.25 * 14, 1e-13);
  simulation.advance(100);
  EXPECT_LT((*simulation.diagnostics().bodies[0].angular_velocity - Vec3(1, 2, 3)).norm(), 1e-13);
}

}  // namespace
}  // namespace vat::test::rigid_test
