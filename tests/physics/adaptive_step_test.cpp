#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/scenes.h"

// Errors and costs of adaptive step control.

namespace vat::adaptive_step_test {
namespace {

using namespace test;

constexpr Real kGravity = 9.81;
constexpr Real kReach = 0.1;       // contact distance of the walls [m]
constexpr Real kTolerance = 1e-5;  // error of bounces

Scene make_adaptive(Scene scene, Real tolerance) {
  scene.numerics.control = StepControl::adaptive;
  scene.numerics.tolerance = tolerance;
  return scene;
}

/// RIG-4: a mass of 1 falls from a height onto a floor.
Scene make_bounce(Real stiffness, Real step, Real height = 1) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, step);
  scene.materials = {make_material("steel")};
  scene.interfaces = {{{"steel", kVatMaterial}, {stiffness, 0}, kReach}};
  scene.vat = Vat{Vec3(-50, -50, 0), Vec3(50, 50, 50), false, {}};
  scene.gravity = {0, 0, -kGravity};
  scene.bodies = {make_body("ball", BodyKind::rigid, "steel",
                            make_particles({{0, 0, kReach + height}}, 1), 1e-6)};
  return scene;
}

struct Outcome {
  Real error = 0;
  std::uint64_t evaluations = 0;
};

/// Returns the largest error of the height after three bounces, over several initial heights. The
/// phase of the step at a contact then does not matter.
Outcome run_bounces(Real stiffness, Real step, StepControl control) {
  constexpr Real kTime = 2.8;
  Outcome outcome;
  for (int n = 0; n < 5; ++n) {
    const Real height = 1 + 0.005 * n;
    Scene scene = make_bounce(stiffness, step, height);
    scene.numerics.control = control;
    scene.numerics.tolerance = kTolerance;
    Simulation simulation = make_simulation(scene);
    const AdvanceReport report =
        simulation.advance(static_cast<std::uint32_t>(std::lround(kTime / step)));
    EXPECT_EQ(report.undone_steps, 0U);
    outcome.evaluations += report.force_evaluations;
    const Real speed = std::sqrt(2 * kGravity * height);
    const Real omega = std::sqrt(stiffness);
    const Real contact = 2 / omega * (std::numbers::pi - std::atan(speed * omega / kGravity));
    const Real since = std::fmod(kTime + speed / kGravity, contact + 2 * speed / kGravity);
    const Real expected = speed * since - kGravity * since * since / 2;
    outcome.error =
        std::max(outcome.error, std::abs(position_of(simulation, 0).z() - kReach - expected));
  }
  return outcome;
}

// A contact takes a thirtieth or a three-hundredth of the time. The saving is that ratio, minus the
// short steps before and after a contact.
TEST(AdaptiveStep, ReachesTheErrorOfFixedStepsAtAFractionOfTheCost) {
  constexpr Real kSaved = 10;
  for (const Real stiffness : {1e4, 1e6}) {
    const Outcome adaptive = run_bounces(stiffness, 5e-3, StepControl::adaptive);
    // Each bounce changes the speed of 4.5 m/s by a tolerance, 2.4, 1.5 and 0.6 s before the end.
    EXPECT_LT(adaptive.error, kTolerance * 4.5 * (2.4 + 1.5 + 0.6)) << stiffness;
    Real step = 2e-3;
    Outcome fixed = run_bounces(stiffness, step, StepControl::fixed);
    while (static_cast<Real>(fixed.evaluations) <
           kSaved * static_cast<Real>(adaptive.evaluations)) {
      EXPECT_GT(fixed.error, adaptive.error) << stiffness << ' ' << step;
      step /= 2;
      fixed = run_bounces(stiffness, step, StepControl::fixed);
    }
    EXPECT_GT(fixed.error, adaptive.error) << stiffness << ' ' << step;
    EXPECT_LE(step, 5e-4);
  }
}

TEST(AdaptiveStep, IsTheNominalOneWithoutALowerLimit) {
  const Scene scene = make_bounce(1e4, 0.02);
  Simulation fixed = make_simulation(scene);
  Simulation adaptive = make_simulation(make_adaptive(scene, 1e-3));
  fixed.advance(10);  // from the 13th step on, the travel limit of 0.05 m would apply
  const AdvanceReport report = adaptive.advance(10);
  EXPECT_EQ(report.steps, 10U);
  EXPECT_EQ(report.least_step, 0.02);
  EXPECT_EQ(report.greatest_step, 0.02);
  EXPECT_EQ(position_of(adaptive, 0), position_of(fixed, 0));
}

// A pile at rest needs stable steps only.
TEST(AdaptiveStep, OfABodyAtRestIsOnlyStable) {
  constexpr Real kStiffness = 1e4;
  Scene scene = make_adaptive(make_bounce(kStiffness, 0.1), 1e-5);
  std::get<ParticleShape>(scene.bodies[0].shape).positions[0].z() = kReach - kGravity / kStiffness;
  Simulation simulation = make_simulation(scene);
  const AdvanceReport report = simulation.advance(20);
  EXPECT_EQ(report.least_step, 0.1 / 6);  // 2 / omega = 0.02, with a margin of a tenth
  EXPECT_NEAR(position_of(simulation, 0).z(), kReach - kGravity / kStiffness, 1e-12);
}

// An oscillator that starts at its turning point, for 100 radians, with a nominal step of one
// radian. The tolerance is an error per radian.
TEST(AdaptiveStep, KeepsTheToleranceFromTheFirstStepOn) {
  for (const IntegratorId integrator :
       {IntegratorId::velocity_verlet, IntegratorId::heun, IntegratorId::runge_kutta_4}) {
    for (const Real tolerance : {1e-3, 1e-5}) {
      Scene scene = make_scene(integrator, 0.1);
      scene.materials = {make_material("m")};
      BodyDescription body = make_body("oscillator", BodyKind::deformable, "m",
                                       make_particles({{0, 0, 0}, {1.2, 0, 0}}, 1), 0.01);
      body.springs = {{0, 1, {100, 0}, 1.0}};
      std::get<ParticleShape>(body.shape).fixed = {0};
      scene.bodies = {body};
      Simulation simulation = make_simulation(make_adaptive(scene, tolerance));
      simulation.advance(100);
      const Real expected = 1 + 0.2 * std::cos(100);
      EXPECT_LT(std::abs(position_of(simulation, 0, 1).x() - expected), 0.2 * 100 * tolerance)
          << to_string(integrator) << ' ' << tolerance;
    }
  }
}

/// A lattice of spacing h / 2 in a periodic box, compressed by a ninth and slightly disturbed.
Scene make_compressed_liquid(int dimensions) {
  constexpr Real kSpacing = 0.05;
  const bool is_plane = dimensions == 2;
  const int n = is_plane ? 16 : 10;
  const Real side = n * kSpacing;
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.8 * 0.1 / 10);  // 0.8 h / c
  scene.dimensions = dimensions;
  scene.materials = {make_liquid("water", 1000, {100, 0, 2 * kSpacing})};
  scene.periodic =
      Periodicity{Vec3::Constant(-side / 2), Vec3::Constant(side / 2), {true, !is_plane, true}};
  const Real mass = 1000 * std::pow(kSpacing, dimensions) * 1.11;
  scene.bodies = {make_body("sea", BodyKind::liquid, "water",
                            make_particles(make_lattice(n, is_plane ? 1 : n, n, kSpacing), mass),
                            kSpacing / 2)};
  scene.bodies[0].spacing = kSpacing;
  scene.bodies[0].jitter = 0.002;
  return make_adaptive(scene, 1);
}

// Such sound waves grow by orders of magnitude with steps of 0.8 h / c, which are stable at rest
// density.
TEST(AdaptiveStep, OfACompressedLiquidIsStable) {
  for (const int dimensions : {2, 3}) {
    Simulation simulation = make_simulation(make_compressed_liquid(dimensions));
    simulation.advance(100);
    const Real before = simulation.diagnostics().kinetic_energy;
    simulation.advance(500);
    EXPECT_LT(simulation.diagnostics().kinetic_energy, 5 * before) << dimensions;
  }
}

// INT: no particle passes a wall and the guard does not act, although a nominal step would move a
// particle by ten wall thicknesses.
TEST(AdaptiveStep, LetsNoProjectilePassAThinWall) {
  for (const IntegratorId integrator : kIntegrators) {
    Scene scene = make_scene(integrator, 0.01);
    scene.materials = {make_material("steel")};
    scene.interfaces = {{{"steel", "steel"}, {1e5, 0}, 0.05}};
    scene.bodies = {
        make_body("wall", BodyKind::rigid, "steel", make_particles(make_lattice(1, 9, 9, 0.03), 10),
                  0.015),
        make_body("shot", BodyKind::rigid, "steel", make_particles({{-1.013, 0, 0}}, 0.001), 0.01)};
    scene.bodies[1].velocity = {50, 0, 0};
    Simulation simulation = make_simulation(make_adaptive(scene, 1e-3));
    const AdvanceReport report = simulation.advance(5);
    EXPECT_EQ(report.undone_steps, 0U) << to_string(integrator);
    EXPECT_LT(velocity_of(simulation, 1).x(), -45) << to_string(integrator);
    EXPECT_LT(report.least_step, 1e-3);
  }
}

// The guard allows a turn of one radian.
TEST(AdaptiveStep, TurnsARigidBodyByAtMostHalfARadian) {
  constexpr Real kRate = 100;  // [rad/s]
  Scene scene = make_adaptive(make_scene(IntegratorId::velocity_verlet, 0.02), 1e-3);
  scene.materials = {make_material("wood")};
  scene.bodies = {make_body("cube", BodyKind::rigid, "wood",
                            make_particles(make_lattice(2, 2, 2, 0.1), 1), 0.05)};
  scene.bodies[0].angular_velocity = {0, 0, kRate};
  const AdvanceReport report = make_simulation(scene).advance(10);
  EXPECT_EQ(report.undone_steps, 0U);
  EXPECT_NEAR(report.greatest_step, 0.5 / kRate, 1e-9);
}

// Particles of a liquid travel at most a quarter of the support radius in a step, relative to the
// mean of the liquid.
TEST(AdaptiveStep, LimitsTheTravelOfALiquid) {
  constexpr Real kSpeed = 100;  // [m/s]
  constexpr Real kSupport = 0.2;
  Scene scene = make_adaptive(make_scene(IntegratorId::velocity_verlet, 0.01), 1);
  scene.materials = {make_liquid("water", 1000, {100, 0, kSupport})};
  for (const Real side : {-1, 1}) {
    scene.bodies.push_back(make_body(side < 0 ? "left" : "right", BodyKind::liquid, "water",
                                     make_particles({{50 * side, 0, 0}}, 1), 0.05));
    scene.bodies.back().velocity = {kSpeed * side, 0, 0};
  }
  const AdvanceReport report = make_simulation(scene).advance(1);
  EXPECT_LE(report.greatest_step, 0.25 * kSupport / kSpeed * (1 + 1e-9));
  EXPECT_GT(report.greatest_step, 0.2 * kSupport / kSpeed);
}

// The stiff spring of this body needs short steps only if it oscillates.
TEST(AdaptiveStep, FollowsTheMotionOfASpringBody) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.01);
  scene.materials = {make_material("rubber")};
  BodyDescription body = make_body("pair", BodyKind::deformable, "rubber",
                                   make_particles({{0, 0, 0}, {1, 0, 0}, {1.1, 0, 0}}, 1), 0.01);
  // The soft spring pulls with 0.1 N, half of which acts on the third particle.
  body.springs = {{0, 1, {1, 0}, 0.9}, {1, 2, {1e4, 0}, 0.1 - 0.05 / 1e4}};
  scene.bodies = {body};
  const auto steps_of = [](const Scene& s) {
    return make_simulation(make_adaptive(s, 1e-4)).advance(100).steps;
  };
  const std::uint64_t calm = steps_of(scene);
  scene.bodies[0].springs[1].rest_length = 0.09;
  const std::uint64_t excited = steps_of(scene);
  EXPECT_LT(calm, 110U);  // 1.4 rad/s; omega_max = 141 rad/s is stable
  const double steps = std::sqrt(2e4) / std::sqrt(24e-4);  // omega / z for 1 s
  EXPECT_NEAR(static_cast<double>(excited), steps, 0.02 * steps);
}

}  // namespace
}  // namespace vat::adaptive_step_test
