#include <gtest/gtest.h>

#include "tests/support/scenes.h"

/// Forces of walls and other bodies on a body, as reported by the diagnostics.
namespace vat::test::outer_force_test {
namespace {

constexpr Real kRadius = 0.05;

BodyDescription block(const char* name, BodyKind kind, const Vec3& position) {
  BodyDescription body =
      make_body(name, kind, "stone", make_particles(make_lattice(2, 2, 2, 0.1), 5), kRadius);
  body.position = position;
  return body;
}

Scene scene_of(std::vector<BodyDescription> bodies) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-4, {make_material("stone")});
  scene.default_interface = {1e4, 10};
  scene.bodies = std::move(bodies);
  return scene;
}

TEST(OuterForce, OnABlockThatRestsOnTheFloorIsItsWeight) {
  constexpr Real kWeight = 8 * 5 * 9.81;
  // Four floor springs carry the body, each a quarter of its weight.
  const Real sag = kWeight / 4 / 1e4;
  Scene scene = scene_of({block("block", BodyKind::rigid, {0, 0, 0.1 - sag})});
  scene.gravity = {0, 0, -9.81};
  scene.vat = Vat{{-1, -1, 0}, {1, 1, 1}, false, {}};
  Simulation simulation = make_simulation(scene);
  ASSERT_TRUE(simulation.apply_force(simulation.bodies()[0].id, {7, 0, 0}, 1));
  ASSERT_TRUE(simulation.grab_start(1, simulation.bodies()[0].id, 0, {0, 0, 1}));
  const BodyDiagnostics at_rest = simulation.diagnostics().bodies[0];
  EXPECT_LT((at_rest.outer_force - Vec3(0, 0, kWeight)).norm(), 1e-9 * kWeight);
  EXPECT_LT(at_rest.outer_torque.norm(), 1e-9 * kWeight);
}

TEST(OuterForce, TurnsABlockThatStandsOnOneEdge) {
  Scene scene = scene_of({block("block", BodyKind::rigid, {0.01, 0, 0.5})});
  scene.vat = Vat{{-0.08, -1, 0}, {1, 1, 1}, false, {}};
  // The four particles at x = -0.04 overlap the reach of the wall at -0.08 by 0.01.
  const BodyDiagnostics body = make_simulation(scene).diagnostics().bodies[0];
  EXPECT_LT((body.outer_force - Vec3(4 * 100, 0, 0)).norm(), 1e-9);
  EXPECT_LT(body.outer_torque.norm(), 1e-9);  // evenly distributed
  scene.bodies[0].orientation = Quat(Eigen::AngleAxis<Real>(0.1, Vec3::UnitY()));
  const BodyDiagnostics turned = make_simulation(scene).diagnostics().bodies[0];
  // Along x, the lower particles are at -(cos + sin) / 20 or -(cos - sin) / 20 from the centre.
  const Real near = 0.05 - (0.09 - 0.05 * (std::cos(0.1) + std::sin(0.1)));
  const Real far = 0.05 - (0.09 - 0.05 * (std::cos(0.1) - std::sin(0.1)));
  EXPECT_NEAR(turned.outer_force.x(), 2e4 * (near + far), 1e-9);
  const Real near_arm = 0.05 * (std::cos(0.1) - std::sin(0.1));
  const Real far_arm = -0.05 * (std::cos(0.1) + std::sin(0.1));
  EXPECT_NEAR(std::abs(turned.outer_torque.y()), 2e4 * std::abs(near * near_arm + far * far_arm),
              1e-9);
}

TEST(OuterForce, OfTwoBodiesInContactIsOpposite) {
  BodyDescription bouncer = block("bouncer", BodyKind::deformable, {0.02, 0.01, 0.19});
  bouncer.springs = join_near(std::get<ParticleShape>(bouncer.shape).positions, 0.15, {1000, 1});
  bouncer.springs[0].rest_length = 0.2;  // internal forces are not outer forces
  Scene scene = scene_of({block("block", BodyKind::rigid, {0, 0, 0}), bouncer});
  scene.gravity = {0, 0, -9.81};
  const Diagnostics diagnostics = make_simulation(scene).diagnostics();
  const BodyDiagnostics& a = diagnostics.bodies[0];
  const BodyDiagnostics& b = diagnostics.bodies[1];
  EXPECT_GT(b.outer_force.z(), 1);
  EXPECT_LT((a.outer_force + b.outer_force).norm(), 1e-10 * a.outer_force.norm());
  // Torques about a common point are opposite too.
  const Vec3 of_a = a.outer_torque + a.center_of_mass.cross(a.outer_force);
  const Vec3 of_b = b.outer_torque + b.center_of_mass.cross(b.outer_force);
  EXPECT_LT((of_a + of_b).norm(), 1e-10 * a.outer_force.norm());
}

TEST(OuterForce, OnAHeldBodyCarriesItsLoad) {
  BodyDescription table = block("table", BodyKind::rigid, {0, 0, 0});
  table.fixed = true;
  Scene scene = scene_of({table, block("load", BodyKind::rigid, {0, 0, 0.19})});
  const Diagnostics diagnostics = make_simulation(scene).diagnostics();
  // Four pairs overlap by 0.01 m each.
  EXPECT_NEAR(diagnostics.bodies[0].outer_force.z(), -4 * 100, 1e-8);
  EXPECT_NEAR(diagnostics.bodies[1].outer_force.z(), 4 * 100, 1e-8);
}

}  // namespace
}  // namespace vat::test::outer_force_test
