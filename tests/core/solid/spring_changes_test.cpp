#include "core/solid/spring_changes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/same_bits.h"
#include "tests/support/scenes.h"

namespace vat::test::spring_changes_test {
namespace {

constexpr Real kLength = 2;  // [m] initial length

TEST(Plasticity, IsElasticUpToTheYieldStrain) {
  const Plasticity plasticity{0.1, 0.5, 0, 0.5};
  for (const Real strain : {-0.1, -0.05, 0.0, 0.1}) {
    EXPECT_EQ(flown_length(plasticity, kLength, kLength, kLength * (1 + 0.999 * strain), 1e-3),
              kLength);
  }
}

TEST(Plasticity, FlowsUntilTheStressIsAtYield) {
  for (const Real hardening : {0.0, 0.25, 4.0}) {
    Real rest = kLength;
    for (const Real strain : {0.15, -0.3, 0.45}) {
      const Plasticity plasticity{0.1, hardening, 0, 0.5};
      const Real length = kLength * (1 + strain);
      rest = flown_length(plasticity, kLength, rest, length, 1e-3);
      const Real flown = rest / kLength - 1;
      EXPECT_NEAR(strain - flown - hardening * flown, std::copysign(0.1, strain), 3e-15);
      EXPECT_NEAR(flown_length(plasticity, kLength, rest, length, 1e-3), rest, 3e-15);
    }
  }
}

TEST(Plasticity, RelaxesExponentially) {
  const Plasticity plasticity{0.1, 0, 2, 0.5};
  Real rest = kLength;
  for (int n = 0; n < 100; ++n) rest = flown_length(plasticity, kLength, rest, 2.6, 0.01);
  // The strain is 0.3, of which 0.2 exceed the yield strain. After 1 s, exp(-1 / 2) of that remains
  // (relaxation time 2 s).
  EXPECT_NEAR(rest / kLength - 1, 0.2 * (1 - std::exp(-0.5)), 1e-13);
}

TEST(Plasticity, EndsAtTheGreatestStrain) {
  const Plasticity plasticity{0.1, 0, 0, 0.25};
  EXPECT_DOUBLE_EQ(flown_length(plasticity, kLength, kLength, 5, 1e-3), 1.25 * kLength);
  EXPECT_DOUBLE_EQ(flown_length(plasticity, kLength, kLength, 0.1, 1e-3), 0.75 * kLength);
  EXPECT_EQ(flown_length(plasticity, 0, 0, 5, 1e-3), 0);  // no length, no strain
}

/// A mass on a spring along x. The other end is fixed.
Scene make_oscillator(IntegratorId integrator, Real step) {
  Scene scene = test::make_oscillator(integrator, step, {100, 0}, 1);
  std::get<ParticleShape>(scene.bodies[0].shape).velocities = {{0, 0, 0}, {3, 0, 0}};
  return scene;
}

// The spring stores k Y^2 / 2 elastically. The rest of m v^2 / 2 becomes plastic at the constant
// force k Y. Then the mass oscillates with amplitude Y about the new rest length.
TEST(Plasticity, LeavesTheSetOfItsEnergy) {
  constexpr Real kYield = 0.1;
  const Real set = (4.5 - 100 * kYield * kYield / 2) / (100 * kYield);
  for (const bool implicit : {false, true}) {
    for (const IntegratorId integrator : kIntegrators) {
      if (implicit && integrator != IntegratorId::velocity_verlet) continue;
      for (const StepControl control :
           {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
        const bool is_verlet = integrator == IntegratorId::velocity_verlet;
        if (control == StepControl::local && (implicit || !is_verlet)) continue;
        Scene scene = make_oscillator(integrator, 1e-4);
        scene.numerics.control = control;
        scene.materials[0].plasticity = Plasticity{kYield, 0, 0, 0.9};
        scene.materials[0].implicit_springs = implicit;
        Simulation simulation = make_simulation(scene);
        Real greatest = 0;
        Real least = 10;
        for (int n = 0; n < 10000; ++n) {
          simulation.advance(1);
          const Real x = position_of(simulation, 0, 1).x() - 1;
          greatest = std::max(greatest, x);
          if (simulation.time() > 0.5) least = std::min(least, x);
        }
        const std::string name = std::string(to_string(integrator)) + ", " + to_string(control);
        // The step that starts to yield has a first-order error: k Y v dt of energy, 3e-4 m.
        // Explicit Euler adds k dt / m of its energy per second.
        const Real tolerance = integrator == IntegratorId::explicit_euler ? 5e-3 : 5e-4;
        EXPECT_NEAR(greatest, kYield + set, tolerance) << name;
        EXPECT_NEAR(least, set - kYield, tolerance) << name;
        EXPECT_EQ(simulation.diagnostics().torn_springs, 0U);
      }
    }
  }
}

TEST(Tearing, IsPermanent) {
  for (const bool implicit : {false, true}) {
    Scene scene = make_oscillator(IntegratorId::velocity_verlet, 1e-3);
    scene.materials[0].tearing_strain = 0.2;  // the oscillation would reach 0.3
    scene.materials[0].implicit_springs = implicit;
    Simulation simulation = make_simulation(scene);
    EXPECT_EQ(simulation.diagnostics().torn_springs, 0U);
    simulation.advance(200);
    EXPECT_EQ(simulation.diagnostics().torn_springs, 1U);
    EXPECT_EQ(simulation.diagnostics().elastic_energy, 0);
    const Vec3 velocity = velocity_of(simulation, 0, 1);
    EXPECT_NEAR(velocity.x(), std::sqrt(9 - 100 * 0.04), 0.03);  // change within a step of 1 ms
    simulation.advance(100);
    EXPECT_EQ(velocity_of(simulation, 0, 1), velocity);
  }
}

TEST(Tearing, EndsTheDashpotToo) {
  Scene scene = make_oscillator(IntegratorId::velocity_verlet, 0.01);
  std::get<ParticleShape>(scene.bodies[0].shape).velocities.clear();
  scene.bodies[0].springs[0] = {0, 1, {100, 1e4}, 0.9};  // the damper needs an implicit solve
  scene.materials[0].tearing_strain = 0.05;
  scene.gravity = {10, 0, 0};
  Simulation simulation = make_advanced(scene, 1);
  ASSERT_EQ(simulation.diagnostics().torn_springs, 1U);
  const Vec3 velocity = velocity_of(simulation, 0, 1);
  simulation.advance(10);
  EXPECT_NEAR(velocity_of(simulation, 0, 1).x() - velocity.x(), 1, 1e-12);
}

/// A block that is torn in two and dented. Its right half separates.
Scene make_torn_block(StepControl control) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.numerics.control = control;
  scene.materials = {make_material("clay")};
  scene.materials[0].plasticity = Plasticity{0.02, 0.1, 0.01, 0.3};
  scene.materials[0].tearing_strain = 0.2;
  ParticleShape shape = make_particles(make_lattice(16, 6, 6, 0.05), 0.05);
  for (const Vec3& place : shape.positions) {
    shape.velocities.push_back({place.x() > 0 ? 6.0 : 0.0, place.z() * 20, 0});
  }
  scene.bodies = {make_body("block", BodyKind::deformable, "clay", shape, 0.02)};
  scene.bodies[0].springs = join_near(shape.positions, 0.075, {2000, 1});
  return scene;
}

TEST(SpringChanges, HaveTheSameBitsForAnyThreads) {
  for (const StepControl control :
       {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
    const Scene scene = make_torn_block(control);
    expect_same_bits(scene, 30, 10);
    Simulation simulation = make_simulation(scene);
    const Diagnostics start = simulation.diagnostics();
    simulation.advance(100);
    const Diagnostics end = simulation.diagnostics();
    EXPECT_GT(end.torn_springs, 100U);
    EXPECT_LT(end.torn_springs, simulation.spring_count() / 2);
    EXPECT_LT((end.bodies[0].linear_momentum - start.bodies[0].linear_momentum).norm(),
              1e-12 * start.bodies[0].linear_momentum.norm());
    EXPECT_LT((end.bodies[0].angular_momentum - start.bodies[0].angular_momentum).norm(),
              1e-12 * start.bodies[0].angular_momentum.norm());
  }
}

TEST(SpringChanges, ArePartOfTheHash) {
  Scene scene = make_oscillator(IntegratorId::runge_kutta_4, 1e-3);
  scene.materials[0].plasticity = Plasticity{0.01, 0, 0, 0.5};
  Simulation one = make_simulation(scene);
  scene.materials[0].plasticity->yield_strain = 0.02;
  Simulation other = make_simulation(scene);
  EXPECT_EQ(one.state_hash(), other.state_hash());
  one.advance(4);  // up to a strain of 0.012; forces were elastic until then
  other.advance(4);
  EXPECT_EQ(position_of(one, 0, 1), position_of(other, 0, 1));
  EXPECT_NE(one.state_hash(), other.state_hash());
}

TEST(SpringChanges, AreKeptAtChangesOfBodies) {
  Scene scene = make_torn_block(StepControl::fixed);
  Simulation simulation = make_advanced(scene, 50);
  const Diagnostics before = simulation.diagnostics();
  BodyDescription other = scene.bodies[0];
  other.name = "other";
  other.position = {0, 10, 0};
  const Result<BodyId> added = simulation.add_body(other);
  ASSERT_TRUE(added.ok());
  EXPECT_EQ(simulation.diagnostics().torn_springs, before.torn_springs);
  ASSERT_TRUE(simulation.remove_body(simulation.bodies()[1].id).ok());
  EXPECT_EQ(simulation.diagnostics().torn_springs, before.torn_springs);
  EXPECT_EQ(simulation.diagnostics().elastic_energy, before.elastic_energy);
}

TEST(SpringChanges, AreUndoneWithTheStep) {
  Scene scene = make_torn_block(StepControl::fixed);
  scene.numerics.step = scene.numerics.tick = 0.02;  // much too long
  scene.materials[0].plasticity->relaxation_time = 0;
  scene.bodies[0].springs =
      join_near(std::get<ParticleShape>(scene.bodies[0].shape).positions, 0.075, {1e9, 0});
  scene.materials[0].tearing_strain = 900;
  Simulation simulation = make_simulation(scene);
  AdvanceReport report;
  for (int n = 0; n < 20 && !report.failed; ++n) {
    const std::uint64_t before = simulation.state_hash();
    report = simulation.advance(1);
    if (report.failed) {
      EXPECT_EQ(simulation.state_hash(), before);
    }
  }
  EXPECT_TRUE(report.failed);
}

}  // namespace
}  // namespace vat::test::spring_changes_test
