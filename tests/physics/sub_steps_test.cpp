#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/state/controls.h"
#include "core/stepping/local_step.h"
#include "core/stepping/step_plan.h"
#include "core/stepping/workspace.h"
#include "tests/support/mixed_scenes.h"
#include "tests/support/momentum_watch.h"
#include "tests/support/same_bits.h"

// Local steps with coupled liquids: solids take sub-steps within a step of the liquid.

namespace vat::sub_steps_test {
namespace {

using namespace test;

constexpr Index kJelly = 2;  // body of make_wet_mixture()

Scene make_mixture(PressureSolver solver, Real stiffness) {
  const bool is_tait = solver == PressureSolver::tait;
  Scene scene = make_wet_mixture(
      is_tait ? IntegratorId::velocity_verlet : IntegratorId::symplectic_euler, solver);
  for (SpringDescription& spring : scene.bodies[kJelly].springs) {
    spring.constants = {stiffness, 1};
  }
  scene.numerics.control = StepControl::local;
  return scene;
}

class SubSteps : public testing::TestWithParam<PressureSolver> {};

TEST_P(SubSteps, HaveTheSameBitsForAnyThreadsAndFromASnapshot) {
  expect_same_bits(make_mixture(GetParam(), 2e5), 60, 40);
}

TEST_P(SubSteps, ConserveMomentum) {
  Simulation simulation = make_simulation(make_mixture(GetParam(), 2e5));
  const MomentumWatch watch(simulation);
  const Vec3 start = simulation.diagnostics().bodies[kJelly].linear_momentum;
  const AdvanceReport report = simulation.advance(200);
  const Vec3 end = simulation.diagnostics().bodies[kJelly].linear_momentum;
  EXPECT_EQ(report.undone_steps, 0U);
  EXPECT_LT(report.least_step, report.greatest_step / 4);
  EXPECT_GT((end - start).norm(), 0.1 * start.norm());  // the liquids have pushed it
  watch.expect_momentum();
  // The density solve of incompressible liquids shifts positions without impulses.
  if (GetParam() == PressureSolver::tait) watch.expect_angular_momentum(1e-10);
}

// The liquids determine the whole step, and are evaluated once in it.
TEST_P(SubSteps, OfAStiffBodyEvaluateTheLiquidsOncePerStep) {
  const auto run = [](const Scene& scene) {
    Simulation simulation = make_simulation(scene);
    return simulation.advance(50);
  };
  const AdvanceReport soft = run(make_mixture(GetParam(), 2e3));
  const AdvanceReport stiff = run(make_mixture(GetParam(), 2e5));
  EXPECT_EQ(stiff.greatest_step, soft.greatest_step);
  EXPECT_LT(stiff.least_step, soft.least_step / 4);
  EXPECT_EQ(stiff.force_evaluations, soft.force_evaluations);
}

INSTANTIATE_TEST_SUITE_P(Solvers, SubSteps,
                         testing::Values(PressureSolver::tait, PressureSolver::incompressible),
                         [](const auto& one) { return std::string(to_string(one.param)); });

// With one level, the steps are those of velocity Verlet, except for rounding.
TEST(SubStepsOfTait, OfOneLevelAreVelocityVerlet) {
  Scene scene = make_mixture(PressureSolver::tait, 2e3);
  scene.numerics.step = 1e-4;
  for (Material& material : scene.materials) {
    material.liquid->viscosity = 0;
    material.liquid->artificial_viscosity = 0;
  }
  for (SpringDescription& spring : scene.bodies[kJelly].springs) spring.constants.damping = 0;
  scene.default_interface = {500, 0};
  Simulation local = make_simulation(scene);
  scene.numerics.control = StepControl::fixed;
  Simulation fixed = make_simulation(scene);
  const AdvanceReport report = local.advance(200);
  fixed.advance(200);
  EXPECT_EQ(report.least_step, 1e-4);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    EXPECT_LT((position_of(local, b) - position_of(fixed, b)).norm(), 1e-9) << b;
  }
}

/// A stiff cube in a compressed liquid, which expands. No force depends on velocities.
Scene make_cube_in_vat() {
  constexpr Real kSpacing = 0.1;
  constexpr int kEdge = 9;
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.pressure_solver = PressureSolver::tait;
  scene.pair_precision = PairPrecision::double_precision;
  scene.default_interface = {0, 0};
  scene.materials = {make_liquid("water", 1000, {100, 0, 2.5 * kSpacing}), make_material("gum")};
  scene.materials[0].liquid->artificial_viscosity = 0;
  const Real half = kEdge * kSpacing / 2;
  scene.vat = Vat{{-half, -half, -half}, {half, half, 2 * half}, false, {}};
  std::vector<Vec3> water;
  std::vector<Vec3> cube;
  for (const Vec3& point : make_lattice(kEdge, kEdge, kEdge, kSpacing)) {
    (point.cwiseAbs().maxCoeff() < 1.5 * kSpacing ? cube : water).push_back(point);
  }
  const Real mass = 1.05 * 1000 * kSpacing * kSpacing * kSpacing;  // compressed by 5 %
  scene.bodies = {
      make_body("water", BodyKind::liquid, "water", make_particles(water, mass), kSpacing / 2),
      make_body("cube", BodyKind::deformable, "gum", make_particles(cube, 2 * mass), kSpacing / 2)};
  scene.bodies[1].springs = join_near(cube, 1.1 * kSpacing, {3e4, 0});
  scene.bodies[1].velocity = {0.3, 0.1, 0.2};
  scene.numerics.control = StepControl::local;
  return scene;
}

/// Returns all positions after 0.02 s of `steps` steps. The cube takes `parts` parts of a step.
std::vector<Vec3> run_cube(int steps, int parts) {
  const Real dt = 0.02 / steps;
  const auto model = compile(make_cube_in_vat(), {1, 2}, {nullptr, nullptr});
  State state = initial_state(*model);
  const Controls controls;
  Workspace work;
  const ForceModel force_model{*model, controls, work};
  StepBounds bounds = find_step_bounds(*model);
  bounds.scene_step = dt;
  std::fill(bounds.own_step.begin(), bounds.own_step.end(), dt);
  std::fill(bounds.own_step.begin() + model->liquid_count, bounds.own_step.end(), dt / parts);
  const GuardBounds guard = guard_bounds(*model);
  LocalStepper stepper;
  for (int n = 0; n < steps; ++n) {
    stepper.take_step(force_model, state, n * dt, dt, bounds, guard);
    EXPECT_EQ(1 << stepper.finest(), parts);
    EXPECT_EQ(stepper.coarsest(), 0);
  }
  return state.now.position;
}

Real distance_between(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  Real greatest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) greatest = std::max(greatest, (a[i] - b[i]).norm());
  return greatest;
}

// The reference has no sub-steps.
TEST(SubStepsOfTait, AreOfOrderTwoInTheStepOfTheLiquid) {
  const std::vector<Vec3> exact = run_cube(1600, 1);
  Real before = 0;
  for (const int steps : {25, 50, 100}) {
    const Real error = distance_between(run_cube(steps, 8), exact);
    if (before > 0) {
      EXPECT_NEAR(std::log2(before / error), 2, 0.2) << steps;
    }
    before = error;
  }
  EXPECT_LT(before, 1e-4);
}

}  // namespace
}  // namespace vat::sub_steps_test
