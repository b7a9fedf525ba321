#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/guard/guard.h"
#include "core/state/controls.h"
#include "core/stepping/control/step_control.h"
#include "core/stepping/local_levels.h"
#include "core/stepping/local_step.h"
#include "core/stepping/step_plan.h"
#include "core/stepping/workspace.h"
#include "tests/support/mixed_scenes.h"
#include "tests/support/same_bits.h"

// Local step control: conservation, accuracy and savings.

namespace vat::local_step_test {
namespace {

using namespace test;

Scene make_local(Scene scene) {
  scene.numerics.control = StepControl::local;
  return scene;
}

/// A liquid block, a stiff deformable body and a rigid body that collide in free space.
Scene make_collision(Real damping, Real viscosity) {
  Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, 2e-3, viscosity);
  scene.default_interface = {5000, damping};
  for (Material& material : scene.materials) material.self_contact->damping = damping;
  scene.bodies = {
      make_block("pool", BodyKind::liquid, "a", 6, {0, 0, 0}, {0, 0, 0}),
      make_block("jelly", BodyKind::deformable, "b", 4, {0.02, 0.01, 0.27}, {0.1, 0.2, -1}),
      make_block("crate", BodyKind::rigid, "b", 4, {0.25, -0.01, 0.03}, {-1, 0.3, 0})};
  for (SpringDescription& spring : scene.bodies[1].springs) {
    spring.constants = {spring.a < 8 ? 2e5 : 2e3, damping};
  }
  return make_local(scene);
}

TEST(LocalStep, GivesTheSameBitsForAnyThreadsAndFromASnapshot) {
  expect_same_bits(make_collision(2, 1), 60, 40);
}

// With one level, local steps equal velocity Verlet, except for rounding.
TEST(LocalStep, OfOneLevelIsVelocityVerlet) {
  Scene scene = make_collision(0, 0);
  scene.numerics.step = 1e-4;
  for (SpringDescription& spring : scene.bodies[1].springs) spring.constants.stiffness = 2e3;
  scene.numerics.control = StepControl::fixed;
  Simulation fixed = make_simulation(scene);
  Simulation local = make_simulation(make_local(scene));
  fixed.advance(300);
  const AdvanceReport report = local.advance(300);
  EXPECT_EQ(report.least_step, 1e-4);
  for (std::size_t b = 0; b < 3; ++b) {
    // The viscous damping of the liquid is evaluated at another time.
    EXPECT_LT((position_of(local, b) - position_of(fixed, b)).norm(), b == 0 ? 1e-5 : 1e-6);
  }
}

/// An undamped chain of four masses, with springs of 1, 30 and 1000 N/m.
Scene make_chain(Real step) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, step);
  scene.materials = {make_material("m")};
  BodyDescription chain =
      make_body("chain", BodyKind::deformable, "m",
                make_particles({{0, 0, 0}, {1, 0, 0}, {1, 1.1, 0}, {1, 1.1, 0.95}}, 1), 0.01);
  chain.springs = {{0, 1, {1, 0}, 0.9}, {1, 2, {30, 0}, 1.0}, {2, 3, {1000, 0}, 1.0}};
  scene.bodies = {chain};
  return make_local(scene);
}

/// Returns the positions of the chain's particles after 1 s. Particles 0 to 3 take 1, 1, 2 and 8
/// parts of a step.
std::vector<Vec3> run_chain(int steps) {
  const Real dt = Real{1} / steps;
  const Scene scene = make_chain(0.01);
  const auto model = compile(scene, {1}, {nullptr});
  State state = initial_state(*model);
  const Controls controls;
  Workspace work;
  const ForceModel force_model{*model, controls, work};
  StepBounds bounds = find_step_bounds(*model);
  bounds.own_step = {dt, dt, dt / 2, dt / 8};
  const GuardBounds guard = guard_bounds(*model);
  LocalStepper stepper;
  for (int n = 0; n < steps; ++n) {
    stepper.take_step(force_model, state, n * dt, dt, bounds, guard);
    EXPECT_EQ(stepper.finest(), 3);
    EXPECT_EQ(stepper.coarsest(), 0);
  }
  return state.now.position;
}

TEST(LocalStep, IsOfOrderTwoWhileLevelsStay) {
  const std::vector<Vec3> exact = run_chain(20000);
  Real before = 0;
  for (const int steps : {50, 100, 200, 400}) {
    const std::vector<Vec3> found = run_chain(steps);
    Real error = 0;
    for (std::size_t i = 0; i < 4; ++i) error = std::max(error, (found[i] - exact[i]).norm());
    if (before > 0) {
      EXPECT_NEAR(std::log2(before / error), 2, 0.2) << steps;
    }
    before = error;
  }
  EXPECT_LT(before, 1e-4);
}

TEST(LocalStep, NeighboursDifferByOneLevelAtMost) {
  const Scene scene = make_chain(0.1);
  const auto model = compile(scene, {1}, {nullptr});
  PresentSteps steps;
  steps.particle = {0.1, 0.1, 0.1, 0.1 / 64};
  LocalLevels levels;
  choose_local_levels(*model, steps, 0.1, levels);
  EXPECT_THAT(levels.particle, ::testing::ElementsAre(3, 4, 5, 6));
}

Real energy_of(const Simulation& simulation) {
  const Diagnostics d = simulation.diagnostics();
  return d.kinetic_energy + d.gravitational_energy + d.elastic_energy + d.contact_energy;
}

/// Two masses on an oscillating spring that fall onto a stiff floor.
Scene make_dumbbell_above_floor() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.01);
  scene.numerics.tolerance = 1e-3;
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_material("m")};
  scene.interfaces = {{{"m", kVatMaterial}, {1e5, 0}, 0.1}};
  scene.vat = Vat{Vec3(-5, -5, 0), Vec3(5, 5, 50), false, {}};
  scene.bodies = {make_body("dumbbell", BodyKind::deformable, "m",
                            make_particles({{0, 0, 0.5}, {0.3, 0, 0.9}}, 1), 0.01)};
  scene.bodies[0].springs = {{0, 1, {200, 0}, 0.45}};
  return make_local(scene);
}

// The floor's steps are a hundredth of the spring's. If levels change, the kick at the start of a
// step must belong to the level of the step.
TEST(LocalStep, KeepsEnergyAtChangesOfLevels) {
  Simulation simulation = make_simulation(make_dumbbell_above_floor());
  const Real before = energy_of(simulation);
  const AdvanceReport report = simulation.advance(300);
  EXPECT_EQ(report.undone_steps, 0U);
  EXPECT_LT(report.least_step, 1e-3);
  EXPECT_EQ(report.greatest_step, 0.01);
  EXPECT_NEAR(energy_of(simulation), before, 2e-2 * 9.81);
}

// Bodies that leave their skins within a step interact with bodies beyond their reach at its start.
TEST(LocalStep, LetsNoProjectilePassAThinWall) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.01);
  scene.materials = {make_material("steel")};
  scene.interfaces = {{{"steel", "steel"}, {1e5, 0}, 0.05}};
  scene.bodies = {
      make_body("wall", BodyKind::rigid, "steel", make_particles(make_lattice(1, 9, 9, 0.03), 10),
                0.015),
      make_body("shot", BodyKind::rigid, "steel", make_particles({{-1.013, 0, 0}}, 0.001), 0.01)};
  for (const Real speed : {20.0, 50.0, 150.0}) {
    scene.bodies[0].velocity = {-speed, 0, 0};
    scene.bodies[1].velocity = {speed, 0, 0};
    Simulation simulation = make_simulation(make_local(scene));
    const AdvanceReport report =
        simulation.advance(static_cast<std::uint32_t>(std::lround(250 / speed)));
    EXPECT_EQ(report.undone_steps, 0U);
    // The wall's mass is 810 000 times that of the projectile.
    EXPECT_NEAR(velocity_of(simulation, 1).x(), -3 * speed, 2e-3 * speed);
  }
}

/// A soft cube hangs on a stiff small cube, which is fixed at a corner: 1000 and 8 particles.
Scene make_soft_and_stiff(Real step) {
  constexpr Real kSpacing = 0.1;
  Scene scene = make_scene(IntegratorId::velocity_verlet, step);
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_material("m")};
  std::vector<Vec3> points = make_lattice(10, 10, 10, kSpacing);
  const std::vector<Vec3> cube = make_lattice(2, 2, 2, kSpacing);
  std::vector<SpringDescription> springs = join_near(points, 1.5 * kSpacing, {1000, 0});
  const auto first = static_cast<Index>(points.size());
  for (SpringDescription spring : join_near(cube, 1.5 * kSpacing, {1e6, 0})) {
    spring.a += first;
    spring.b += first;
    springs.push_back(spring);
  }
  for (const Vec3& p : cube) points.push_back(p + Vec3(0, 0, 0.6));
  for (Index a = 0; a < first; ++a) {
    for (Index b = first; b < points.size(); ++b) {
      if ((points[a] - points[b]).norm() < 1.1 * kSpacing) springs.push_back({a, b, {1000, 0}, {}});
    }
  }
  BodyDescription body =
      make_body("lamp", BodyKind::deformable, "m", make_particles(points, 0.01), 0.01);
  body.springs = springs;
  std::get<ParticleShape>(body.shape).fixed = {first + 4};
  scene.bodies = {body};
  return scene;
}

// The stiff part is unstable with steps above 5e-5, the soft part above 1e-3. The fine and coarse
// springs balance over a coarse step. The particles that carry the soft cube accelerate with about
// 2000 m/s^2, so they move by a dt^2 / 12 between kicks.
TEST(LocalStep, SavesTheEvaluationsThatOnlyAStiffPartNeeds) {
  constexpr Real kTime = 0.2;
  const auto run = [](const Scene& scene, AdvanceReport& report) {
    Simulation simulation = make_simulation(scene);
    report =
        simulation.advance(static_cast<std::uint32_t>(std::lround(kTime / scene.numerics.step)));
    EXPECT_EQ(report.undone_steps, 0U);
    const BodyView body = simulation.bodies()[0];
    return std::vector<Vec3>(body.positions.begin(), body.positions.end());
  };
  const auto error_of = [](const std::vector<Vec3>& found, const std::vector<Vec3>& exact) {
    Real sum = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) sum += (found[i] - exact[i]).squaredNorm();
    return std::sqrt(sum / static_cast<Real>(exact.size()));
  };
  AdvanceReport reference;
  AdvanceReport fixed;
  AdvanceReport local;
  const std::vector<Vec3> exact = run(make_soft_and_stiff(5e-6), reference);
  const Real fixed_error = error_of(run(make_soft_and_stiff(5e-5), fixed), exact);
  const Real local_error = error_of(run(make_local(make_soft_and_stiff(5e-4)), local), exact);
  const Real fall = 9.81 * kTime * kTime / 2;
  EXPECT_LT(local_error, 1e-3 * fall);
  EXPECT_LT(fixed_error, 1e-3 * fall);
  const Real saved =
      static_cast<Real>(fixed.particle_evaluations) / static_cast<Real>(local.particle_evaluations);
  EXPECT_GT(saved, 4);
  RecordProperty("saved", std::to_string(saved));
}

}  // namespace
}  // namespace vat::local_step_test
