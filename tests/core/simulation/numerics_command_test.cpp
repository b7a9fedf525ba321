// Changes of the integrator and the step while a simulation runs.

#include <gtest/gtest.h>

#include <cmath>

#include "core/limits.h"
#include "tests/support/edited_scene.h"
#include "tests/support/errors.h"
#include "tests/support/saved_bits.h"

namespace vat::test::numerics_command_test {
namespace {

/// A scene with 20 steps per tick.
Scene ticked_scene() {
  Scene scene = sampled_scene();
  scene.numerics.tick = 0.02;
  return scene;
}

void run_ticks(Simulation& simulation, int ticks) {
  for (int tick = 0; tick < ticks; ++tick) simulation.advance(simulation.steps_per_tick());
}

TEST(SetNumerics, OfASceneAtItsStartAreAsThoughItHadThem) {
  for (const IntegratorId integrator : kIntegrators) {
    Simulation simulation = make_simulation(ticked_scene());
    const Real step = simulation.scene().numerics.tick / 16;
    ASSERT_TRUE(simulation.set_numerics(integrator, step).ok());
    Scene described = ticked_scene();
    described.numerics.integrator = integrator;
    described.numerics.step = step;
    Simulation expected = make_simulation(described);
    EXPECT_EQ(simulation.steps_per_tick(), 16U);
    for (int tick = 0; tick < 3; ++tick) {
      run_ticks(simulation, 1);
      run_ticks(expected, 1);
      EXPECT_EQ(simulation.state_hash(), expected.state_hash()) << to_string(integrator);
    }
    EXPECT_EQ(simulation.scene().numerics.integrator, integrator);
  }
}

TEST(SetNumerics, LeaveTimeAndStateAsTheyAre) {
  Simulation simulation = make_simulation(ticked_scene());
  run_ticks(simulation, 5);
  const Real time = simulation.time();
  const Real tick = simulation.scene().numerics.tick;
  const auto places = copy_of(simulation.bodies()[1].positions);
  const auto velocities = copy_of(simulation.bodies()[0].velocities);
  const RigidPose pose = *simulation.bodies()[2].pose;
  ASSERT_TRUE(simulation.set_numerics(IntegratorId::runge_kutta_4, tick / 7).ok());
  EXPECT_NEAR(simulation.time(), time, 1e-15);
  EXPECT_EQ(simulation.scene().numerics.tick, tick);
  EXPECT_EQ(copy_of(simulation.bodies()[1].positions), places);
  EXPECT_EQ(copy_of(simulation.bodies()[0].velocities), velocities);
  EXPECT_EQ(simulation.bodies()[2].pose->center_of_mass, pose.center_of_mass);
  run_ticks(simulation, 5);
  EXPECT_NEAR(simulation.time(), 2 * time, 1e-14);
  expect_goes_on(simulation, 5);
}

/// A ball in free fall.
Scene ball_scene(Real step) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, step);
  scene.numerics.tick = 0.02;
  scene.materials = {make_material("wood")};
  scene.bodies = {make_body("ball", BodyKind::rigid, "wood", make_particles({{0, 0, 0}}, 2), 0.05)};
  return scene;
}

TEST(SetNumerics, KeepTheImpulseOfAForceThatActs) {
  Simulation simulation = make_simulation(ball_scene(1e-3));
  const BodyId id = simulation.bodies()[0].id;
  ASSERT_TRUE(simulation.apply_force(id, {3, 0, 0}, 0.027).ok());
  run_ticks(simulation, 1);
  // 7 ms remain: two steps of 4 ms.
  ASSERT_TRUE(simulation.set_numerics(IntegratorId::velocity_verlet, 4e-3).ok());
  simulation.advance(1);
  const Real still = 3 * (0.020 + 0.0035) / 2;
  EXPECT_NEAR(simulation.bodies()[0].pose->velocity.x(), still, 1e-14);
  run_ticks(simulation, 2);
  EXPECT_NEAR(simulation.bodies()[0].pose->velocity.x(), 3 * 0.027 / 2, 1e-14);
}

TEST(SetNumerics, ReleaseABodyAtItsTime) {
  Scene scene = ball_scene(1e-3);
  scene.gravity = {0, 0, -10};
  scene.bodies[0].release = 0.1;
  Simulation simulation = make_simulation(scene);
  run_ticks(simulation, 2);
  ASSERT_TRUE(simulation.set_numerics(IntegratorId::velocity_verlet, 2.5e-4).ok());
  run_ticks(simulation, 8);
  // Velocity Verlet is exact in free fall for 0.1 s.
  EXPECT_NEAR(simulation.bodies()[0].pose->velocity.z(), -1, 1e-12);
  EXPECT_NEAR(simulation.bodies()[0].pose->center_of_mass.z(), -0.05, 1e-12);
}

TEST(SetNumerics, KeepHeldBodiesAsNewlyGrabbedOnes) {
  for (const std::size_t body : {0U, 1U, 2U}) {
    Simulation before = make_simulation(ticked_scene());
    Simulation after = make_simulation(ticked_scene());
    const BodyId id = before.bodies()[body].id;
    ASSERT_TRUE(before.grab_start(1, id, 0, {0.5, 0.5, 0.5}).ok());
    ASSERT_TRUE(before.set_numerics(IntegratorId::velocity_verlet, 0.02).ok());
    ASSERT_TRUE(after.set_numerics(IntegratorId::velocity_verlet, 0.02).ok());
    ASSERT_TRUE(after.grab_start(1, id, 0, {0.5, 0.5, 0.5}).ok());
    EXPECT_EQ(before.state_hash(), after.state_hash());
    before.advance(1);
    after.advance(1);
    EXPECT_EQ(before.state_hash(), after.state_hash());
  }
}

TEST(SetNumerics, GoBackWithASnapshot) {
  Simulation simulation = make_simulation(ticked_scene());
  const Snapshot start = simulation.snapshot();
  run_ticks(simulation, 2);
  const std::uint64_t hash = simulation.state_hash();
  simulation.restore(start);
  ASSERT_TRUE(simulation.set_numerics(IntegratorId::heun, 1e-4).ok());
  run_ticks(simulation, 1);
  simulation.restore(start);
  run_ticks(simulation, 2);
  EXPECT_EQ(simulation.state_hash(), hash);
}

TEST(SetNumerics, AreRefusedByTheirPlaceAndChangeNothing) {
  Simulation simulation = make_simulation(ticked_scene());
  const Real step = simulation.step_size();
  const std::uint64_t hash = simulation.state_hash();
  const auto verlet = IntegratorId::velocity_verlet;
  for (const Real wrong : {0.0, -step, 0.7 * step, 0.03, std::nan(""), kMinStep / 2}) {
    EXPECT_EQ(errors_of(simulation.set_numerics(verlet, wrong)), "out_of_range /step") << wrong;
  }
  EXPECT_EQ(simulation.state_hash(), hash);
  EXPECT_TRUE(simulation.set_numerics(verlet, step).ok());
  EXPECT_EQ(simulation.state_hash(), hash);
  simulation.advance(1);
  EXPECT_EQ(errors_of(simulation.set_numerics(verlet, step / 2)), "not_allowed /step");
  EXPECT_TRUE(simulation.set_numerics(IntegratorId::heun, step).ok()) << "allowed at any time";
}

TEST(SetNumerics, AreThoseThatTheSceneCanHave) {
  Scene projecting = ticked_scene();
  projecting.default_interface = InterfaceConstants{.law = InterfaceLaw::projection};
  Scene implicit = ticked_scene();
  implicit.materials[1].implicit_springs = true;
  Scene local = ticked_scene();
  local.pressure_solver = PressureSolver::gas;
  local.numerics.control = StepControl::local;
  for (const Scene& scene : {projecting, implicit, local}) {
    Simulation simulation = make_simulation(scene);
    const std::uint64_t hash = simulation.state_hash();
    EXPECT_EQ(errors_of(simulation.set_numerics(IntegratorId::heun, simulation.step_size())),
              "not_allowed /integrator");
    EXPECT_EQ(simulation.state_hash(), hash);
  }
}

TEST(SetNumerics, OfASceneWithEmittersKeepTheStep) {
  Simulation simulation = make_simulation(scene_with_tap(ticked_scene()));
  run_ticks(simulation, 3);
  const Real step = simulation.step_size();
  EXPECT_EQ(errors_of(simulation.set_numerics(IntegratorId::velocity_verlet, step / 2)),
            "not_allowed /step");
  EXPECT_TRUE(simulation.set_numerics(IntegratorId::symplectic_euler, step).ok());
  expect_goes_on(simulation, 5);
}

TEST(SetNumerics, ControlAndTolerancesAreAsThoughTheSceneHadThem) {
  for (const StepControl control : {StepControl::adaptive, StepControl::local}) {
    Simulation simulation = make_simulation(ticked_scene());
    ASSERT_TRUE(simulation.set_numerics({.control = control, .tolerance = 0.05}).ok());
    Scene described = ticked_scene();
    described.numerics.control = control;
    described.numerics.tolerance = 0.05;
    Simulation expected = make_simulation(described);
    for (int tick = 0; tick < 3; ++tick) {
      run_ticks(simulation, 1);
      run_ticks(expected, 1);
      EXPECT_EQ(simulation.state_hash(), expected.state_hash()) << to_string(control);
    }
    ASSERT_TRUE(simulation.set_numerics({.control = StepControl::fixed}).ok());
    expect_goes_on(simulation, 3);
  }
}

TEST(SetNumerics, TolerancesOfIncompressibleLiquidsChange) {
  Scene scene = ticked_scene();
  scene.pressure_solver = PressureSolver::incompressible;
  scene.numerics.integrator = IntegratorId::symplectic_euler;
  Simulation simulation = make_simulation(scene);
  ASSERT_TRUE(
      simulation.set_numerics({.density_tolerance = 0.01, .divergence_tolerance = 0.02}).ok());
  scene.incompressible.density_tolerance = 0.01;
  scene.incompressible.divergence_tolerance = 0.02;
  Simulation expected = make_simulation(scene);
  run_ticks(simulation, 3);
  run_ticks(expected, 3);
  EXPECT_EQ(simulation.state_hash(), expected.state_hash());
  expect_goes_on(simulation, 3);
}

TEST(SetNumerics, WrongControlAndTolerancesAreNamed) {
  Simulation simulation = make_simulation(ticked_scene());
  const std::uint64_t hash = simulation.state_hash();
  EXPECT_EQ(errors_of(simulation.set_numerics({.tolerance = 0})), "out_of_range /tolerance");
  EXPECT_EQ(errors_of(simulation.set_numerics({.density_tolerance = 1})),
            "out_of_range /density_tolerance");
  EXPECT_EQ(errors_of(simulation.set_numerics({.divergence_tolerance = 1})),
            "out_of_range /divergence_tolerance");
  EXPECT_EQ(errors_of(simulation.set_numerics(
                {.integrator = IntegratorId::heun, .control = StepControl::local})),
            "not_allowed /control");
  EXPECT_TRUE(simulation.set_numerics(NumericsChange{}).ok());
  EXPECT_EQ(simulation.state_hash(), hash);
  Scene projecting = ticked_scene();
  projecting.default_interface = InterfaceConstants{.law = InterfaceLaw::projection};
  EXPECT_EQ(errors_of(make_simulation(projecting).set_numerics({.control = StepControl::local})),
            "not_allowed /control");
}

}  // namespace
}  // namespace vat::test::numerics_command_test
