#include <gtest/gtest.h>

#include <random>

#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"

namespace vat::test::springs_test {
namespace {

Scene make_spring_scene(std::vector<Vec3> positions, std::vector<SpringDescription> springs) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3, {make_material("rubber")});
  scene.bodies = {make_body("body", BodyKind::deformable, "rubber",
                            make_particles(std::move(positions), 1), 0.01)};
  scene.bodies[0].springs = std::move(springs);
  return scene;
}

TEST(Springs, RestAtTheLengthOfTheStartUnlessGivenOne) {
  const ForceProbe probe(make_spring_scene({{0, 0, 0}, {1, 2, 2}}, {{0, 1, {40, 3}, {}}}));
  EXPECT_LT(probe.force(0, 0).norm(), 1e-13);
}

TEST(Springs, AreDampedAlongTheirLineOnly) {
  Scene scene = make_spring_scene({{0, 0, 0}, {1, 0, 0}}, {{0, 1, {40, 3}, 1.0}});
  std::get<ParticleShape>(scene.bodies[0].shape).velocities = {{0.5, 2, 0}, {-1.5, 7, 1}};
  const ForceProbe probe(scene);
  EXPECT_NEAR(probe.force(0, 0).x(), -3 * 2, 1e-12);  // approach at 2 m/s: repulsion
  EXPECT_EQ(probe.force(0, 0).y(), 0);
  EXPECT_EQ(probe.force(0, 0), Vec3(-probe.force(0, 1)));
}

TEST(Springs, OfNoLengthStillPushOppositeWays) {
  const ForceProbe probe(make_spring_scene({{1, 1, 1}, {1, 1, 1}}, {{0, 1, {40, 0}, 0.5}}));
  EXPECT_NEAR(probe.force(0, 0).norm(), 20, 1e-12);
  EXPECT_EQ(probe.force(0, 0), Vec3(-probe.force(0, 1)));
}

TEST(Springs, SumAsBruteForceDoesAndCancel) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<Real> unit(-1, 1);
  std::vector<Vec3> positions(3 * kBlockSize - 100);  // springs cross blocks in both directions
  for (Vec3& p : positions) p = {unit(random), unit(random), unit(random)};
  std::vector<SpringDescription> springs;
  for (Index s = 0; s < 3000; ++s) {
    const auto a = static_cast<Index>(random() % positions.size());
    const auto b = static_cast<Index>(random() % positions.size());
    if (a != b) springs.push_back({a, b, {10 + 5 * unit(random), 0}, 0.7});
  }
  std::vector<Vec3> expected(positions.size(), Vec3::Zero());
  for (const SpringDescription& spring : springs) {
    const Vec3 x = positions[spring.b] - positions[spring.a];
    const Vec3 force = spring.constants.stiffness * (x.norm() - 0.7) * x.normalized();
    expected[spring.a] += force;
    expected[spring.b] -= force;
  }
  const ForceProbe probe(make_spring_scene(positions, springs));
  Vec3 sum = Vec3::Zero();
  for (Index i = 0; i < positions.size(); ++i) {
    EXPECT_LT((probe.force(0, i) - expected[i]).norm(), 1e-12);
    sum += probe.force(0, i);
  }
  EXPECT_LT(sum.norm(), 1e-11);
}

TEST(Springs, DoNotMoveFixedParticles) {
  Scene scene = make_spring_scene({{0, 0, 0}, {2, 0, 0}}, {{0, 1, {40, 0}, 1.0}});
  auto& shape = std::get<ParticleShape>(scene.bodies[0].shape);
  shape.fixed = {0};
  shape.velocities = {{3, 0, 0}, {0, 0, 0}};  // velocity of a fixed particle is zero too
  scene.gravity = {0, 0, -9.81};
  for (const IntegratorId integrator : kIntegrators) {
    scene.numerics.integrator = integrator;
    Simulation simulation = make_advanced(scene, 50);
    EXPECT_EQ(position_of(simulation, 0, 0), Vec3::Zero()) << to_string(integrator);
    EXPECT_EQ(velocity_of(simulation, 0, 0), Vec3::Zero()) << to_string(integrator);
    EXPECT_LT(position_of(simulation, 0, 1).x(), 2);
  }
}

}  // namespace
}  // namespace vat::test::springs_test
