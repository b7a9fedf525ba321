#include <gtest/gtest.h>

#include "tests/core/support/resting_scenes.h"
#include "tests/support/memory/allocation_counter.h"
#include "tests/support/same_bits.h"

// Sleep as part of the state.

namespace vat::test::sleep_state_test {
namespace {

constexpr std::uint32_t kAsleep = 200;  ///< steps until all bodies except the marble sleep
constexpr std::uint32_t kStruck = 80;   ///< further steps until the stack is awake again

TEST(SleepState, HasTheSameBitsForAnyThreadsAndFromASnapshot) {
  Simulation simulation = make_advanced(make_struck_stack(), kAsleep);
  ASSERT_EQ(simulation.diagnostics().sleeping_bodies, 3U);
  simulation.advance(kStruck);
  ASSERT_EQ(simulation.diagnostics().sleeping_bodies, 1U);
  expect_same_bits(make_struck_stack(), kAsleep, kStruck + 300);
  expect_same_bits(make_struck_stack(), 10, kAsleep);
  expect_same_bits(make_struck_stack(), kAsleep + kStruck, 300);
}

/// Bodies with plastic springs, and local steps of all particles.
TEST(SleepState, OfDeformableBodiesHasTheSameBitsToo) {
  for (const StepControl control :
       {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
    Scene scene = make_resting_scene(2e-3);
    scene.numerics.control = control;
    scene.default_interface = {2000, 20, 0.3};
    scene.materials.push_back(make_material("clay"));
    scene.materials[1].plasticity = Plasticity{0.02, 0.1, 0.01, 0.5};
    for (const Real x : {0.0, 3.0}) {
      BodyDescription clay = make_crate("clay " + std::to_string(x), x);
      clay.kind = BodyKind::deformable;
      clay.material = "clay";
      const auto points = std::get<ParticleShape>(clay.shape).positions;
      clay.springs = join_near(points, 0.18, {2000, 10});
      scene.bodies.push_back(clay);
    }
    scene.bodies.push_back(make_crate("falls", {0.02, 0.03, 8}));
    scene.sleeping = Sleeping{0.01, 0.2};
    Simulation simulation = make_advanced(scene, 550);
    ASSERT_EQ(simulation.sleeping_body_count(), 2U) << to_string(control);
    simulation.advance(120);
    ASSERT_EQ(simulation.sleeping_body_count(), 1U) << to_string(control);
    expect_same_bits(scene, 550, 200);
  }
}

TEST(SleepState, IsInTheHash) {
  // Equal positions and velocities, but only one of the simulations has slept.
  Scene scene = make_resting_scene();
  scene.gravity.setZero();
  scene.bodies = {make_crate("crate", {0, 0, 3})};
  Simulation sleeps = make_simulation(scene);
  scene.sleeping->after = 3;
  Simulation waits = make_simulation(scene);
  Scene never = scene;
  never.sleeping.reset();
  Simulation awake = make_simulation(never);
  for (Simulation* each : {&sleeps, &waits, &awake}) each->advance(480);
  ASSERT_TRUE(is_asleep(sleeps, "crate"));
  ASSERT_FALSE(is_asleep(waits, "crate"));
  ASSERT_EQ(position_of(sleeps, 0), position_of(waits, 0));
  EXPECT_NE(sleeps.state_hash(), waits.state_hash());
  EXPECT_NE(waits.state_hash(), awake.state_hash());
}

TEST(SleepState, AFailedCallDoesNotChangeTheSleepers) {
  Scene scene = make_struck_stack();
  scene.bodies.push_back(make_marble("rocket", {10, 0, 1}));
  Simulation simulation = make_simulation(scene);
  // The rocket accelerates at 80 m/s^2. After 1.2 s it is too fast for the guard even in eighths of
  // a step. By then the stack has been hit.
  const BodyId rocket = simulation.find_body("rocket").value();
  ASSERT_TRUE(simulation.apply_force(rocket, {0, 0, 0.5 * 89.81}, 10).ok());
  ASSERT_FALSE(simulation.advance(kAsleep).failed);
  ASSERT_EQ(simulation.diagnostics().sleeping_bodies, 3U);
  const std::uint64_t before = simulation.state_hash();
  const Snapshot snapshot = simulation.snapshot();
  const AdvanceReport report = simulation.advance(240);
  ASSERT_TRUE(report.failed);
  EXPECT_EQ(simulation.state_hash(), before);
  EXPECT_EQ(simulation.diagnostics().sleeping_bodies, 3U);
  simulation.advance(5);
  const std::uint64_t later = simulation.state_hash();
  simulation.restore(snapshot);
  simulation.advance(5);
  EXPECT_EQ(simulation.state_hash(), later);
}

TEST(SleepState, ViewsAndDiagnosticsAreOfAllBodies) {
  Scene scene = make_struck_stack();
  Scene awake = scene;
  awake.sleeping.reset();
  Simulation a = make_simulation(scene);
  Simulation b = make_simulation(awake);
  a.advance(kAsleep);
  b.advance(kAsleep);
  ASSERT_EQ(a.diagnostics().sleeping_bodies, 3U);
  EXPECT_EQ(a.particle_count(), b.particle_count());
  EXPECT_EQ(a.bodies().size(), 4U);
  EXPECT_EQ(a.scene().bodies.size(), 4U);
  EXPECT_EQ(a.plan_text(), b.plan_text());
  const Diagnostics of_a = a.diagnostics();
  const Diagnostics of_b = b.diagnostics();
  EXPECT_EQ(of_b.sleeping_bodies, 0U);

  const Real time = a.time();
  const Real bound = scene.sleeping->speed * time;  // bound of positions
  Real weight = 0;
  for (std::size_t body = 0; body < 4; ++body) {
    EXPECT_EQ(of_a.bodies[body].mass, of_b.bodies[body].mass);
    EXPECT_LE((of_a.bodies[body].center_of_mass - of_b.bodies[body].center_of_mass).norm(), bound);
    weight += 9.81 * of_a.bodies[body].mass;
  }
  EXPECT_NEAR(of_a.gravitational_energy, of_b.gravitational_energy, weight * bound);
}

TEST(SleepState, NoAllocationInAStepWithSleepers) {
  for (const bool has_marble : {true, false}) {
    Scene scene = make_resting_scene();
    scene.default_interface.restitution = 1;  // the marble bounces forever
    scene.bodies = {make_crate("crate", 0.0)};
    if (has_marble) scene.bodies.push_back(make_marble("marble", {3, 0, 0.5}));
    Simulation simulation =
        make_advanced(scene, 481);  // the state before waking is stored for a failure
    ASSERT_TRUE(is_asleep(simulation, "crate"));
    ASSERT_EQ(simulation.sleeping_body_count(), 1U);
    const std::size_t before = allocation_count();
    simulation.advance(240);
    EXPECT_EQ(allocation_count(), before);
  }
}

}  // namespace
}  // namespace vat::test::sleep_state_test
