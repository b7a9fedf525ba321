#include "core/solid/elongation_limit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/validation/validate.h"
#include "tests/support/distance.h"
#include "tests/support/errors.h"
#include "tests/support/force_probe.h"
#include "tests/support/same_bits.h"
#include "tests/support/scenes.h"

namespace vat::test::elongation_limit_test {
namespace {

constexpr Real kLimit = 0.1;

/// A square of soft cloth that is fixed at two corners.
Scene make_cloth(Real step) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, step);
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_material("cloth")};
  scene.materials[0].elongation_limit = kLimit;
  ParticleShape shape = make_particles(make_lattice(17, 17, 1, 0.05), 0.002);
  shape.fixed = {0, 16};
  scene.bodies = {make_body("cloth", BodyKind::deformable, "cloth", shape, 0.02)};
  scene.bodies[0].springs = join_near(shape.positions, 0.075, {2, 0.02});
  return scene;
}

/// Returns the largest strain of the cloth's springs.
Real greatest_strain(const Scene& scene, const Simulation& simulation) {
  const auto& start = std::get<ParticleShape>(scene.bodies[0].shape).positions;
  const auto now = simulation.bodies()[0].positions;
  Real greatest = 0;
  for (const SpringDescription& s : scene.bodies[0].springs) {
    const Real length = distance_between(now[s.a], now[s.b]);
    greatest = std::max(greatest, length / distance_between(start[s.a], start[s.b]) - 1);
  }
  return greatest;
}

/// Returns the largest strain in the first 1.5 s, in which the cloth falls and swings up.
Real greatest_strain(const Scene& scene) {
  Simulation simulation = make_simulation(scene);
  Real greatest = 0;
  while (simulation.time() < 1.5) {
    simulation.advance(1);
    greatest = std::max(greatest, greatest_strain(scene, simulation));
  }
  return greatest;
}

// The strain exceeds the limit only by the rotation of springs in a step, (w dt)^2 / 2.
TEST(ElongationLimit, HoldsACloth) {
  for (const IntegratorId integrator :
       {IntegratorId::velocity_verlet, IntegratorId::symplectic_euler}) {
    Real beyond[2];
    for (const int part : {0, 1}) {
      Scene scene = make_cloth(part == 0 ? 1e-3 : 5e-4);
      scene.numerics.integrator = integrator;
      beyond[part] = greatest_strain(scene) - kLimit;
    }
    EXPECT_LT(beyond[1], 0.005) << to_string(integrator);
    EXPECT_NEAR(std::log2(beyond[0] / beyond[1]), 2, 0.3) << to_string(integrator);
  }
  Scene scene = make_cloth(1e-3);
  scene.materials[0].elongation_limit.reset();
  EXPECT_GT(greatest_strain(scene), 5 * kLimit);
}

TEST(ElongationLimit, KeepsMomentumAndTakesEnergy) {
  Scene scene = make_cloth(1e-3);
  scene.gravity.setZero();
  auto& shape = std::get<ParticleShape>(scene.bodies[0].shape);
  shape.fixed.clear();
  for (const Vec3& x : shape.positions) shape.velocities.push_back(10 * x + Vec3(0, 0, x.x()));
  Simulation simulation = make_simulation(scene);
  Diagnostics last = simulation.diagnostics();
  const Diagnostics start = last;
  for (int n = 0; n < 100; ++n) {
    simulation.advance(1);
    const Diagnostics now = simulation.diagnostics();
    EXPECT_LT((now.bodies[0].linear_momentum - start.bodies[0].linear_momentum).norm(), 1e-13);
    EXPECT_LT((now.bodies[0].angular_momentum - start.bodies[0].angular_momentum).norm(), 1e-13);
    last = now;
  }
  EXPECT_LT(last.kinetic_energy + last.elastic_energy,
            0.9 * (start.kinetic_energy + start.elastic_energy));
}

TEST(ElongationLimit, ColoursSpringsThatShareNoParticle) {
  const ForceProbe probe(make_cloth(1e-3));
  const Model& model = probe.model();
  EXPECT_EQ(model.limited_springs.size(), model.spring_ends.size() / 2);
  EXPECT_EQ(model.limited_begin.back(), model.limited_springs.size());
  EXPECT_LE(model.limited_begin.size(), 16U);  // eight neighbours need at most 15 colours
  for (std::size_t c = 0; c + 1 < model.limited_begin.size(); ++c) {
    std::set<Index> seen;
    for (Index s = model.limited_begin[c]; s < model.limited_begin[c + 1]; ++s) {
      EXPECT_TRUE(seen.insert(model.limited_springs[s].a).second);
      EXPECT_TRUE(seen.insert(model.limited_springs[s].b).second);
    }
  }
}

TEST(ElongationLimit, HasTheSameBitsForAnyThreads) {
  expect_same_bits(make_cloth(1e-3), 100, 20);
  Scene scene = make_cloth(1e-3);
  scene.numerics.control = StepControl::adaptive;
  scene.materials[0].tearing_strain = 0.09;
  scene.materials[0].plasticity = Plasticity{0.05, 0, 0, 0.5};
  expect_same_bits(scene, 100, 20);
}

TEST(ElongationLimit, LeavesTornSpringsAlone) {
  Scene scene = make_cloth(1e-3);
  scene.materials[0].tearing_strain = 0.02;
  Simulation simulation = make_advanced(scene, 1000);
  EXPECT_GT(simulation.diagnostics().torn_springs, 0U);
  EXPECT_GT(greatest_strain(scene, simulation), 1);
}

TEST(ElongationLimit, NeedsAMethodWithOneDrift) {
  Scene scene = make_cloth(1e-3);
  EXPECT_TRUE(find_errors(scene).empty());
  scene.numerics.integrator = IntegratorId::heun;
  EXPECT_EQ(errors_of(find_errors(scene)), "not_allowed /numerics/integrator");
  scene.numerics.integrator = IntegratorId::velocity_verlet;
  scene.numerics.control = StepControl::local;
  EXPECT_EQ(errors_of(find_errors(scene)), "not_allowed /numerics/control");
  scene.numerics.control = StepControl::fixed;
  scene.materials[0].implicit_springs = true;
  EXPECT_EQ(errors_of(find_errors(scene)), "not_allowed /materials/0/elongation_limit");
}

}  // namespace
}  // namespace vat::test::elongation_limit_test
