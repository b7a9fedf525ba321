#include "core/guard/guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/limits.h"
#include "tests/support/force_probe.h"
#include "tests/support/mixed_scenes.h"
#include "tests/support/thread_runner.h"

namespace vat::guard_test {
namespace {

using namespace test;

constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
constexpr Real kStep = 1e-3;

/// Eight particles of each kind, far apart.
Scene make_three_kinds() {
  Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, kStep);
  scene.bodies = {make_block("liquid", BodyKind::liquid, "a", 2, {0, 0, 0.5}, Vec3::Zero()),
                  make_block("deformable", BodyKind::deformable, "a", 2, {1, 0, 0.5}, Vec3::Zero()),
                  make_block("rigid", BodyKind::rigid, "a", 2, {2, 0, 0.5}, Vec3::Zero())};
  return scene;
}

/// Returns the fault in the scene's initial state after `spoil` has changed it.
template <class Spoil>
std::optional<Fault> fault_after(const Spoil& spoil) {
  const Scene scene = make_three_kinds();
  ForceProbe probe(scene);
  spoil(probe.state().now);
  return find_fault(probe.model(), probe.state().now, guard_bounds(probe.model()), kStep);
}

void expect_fault(const std::optional<Fault>& fault, GuardEvent::Cause cause, Index body,
                  Index particle) {
  ASSERT_TRUE(fault.has_value());
  EXPECT_EQ(fault->cause, cause) << to_string(fault->cause);
  EXPECT_EQ(fault->body, body);
  EXPECT_EQ(fault->particle, particle);
}

TEST(Guard, FindsNothingInASoundState) {
  EXPECT_FALSE(fault_after([](Configuration&) {}).has_value());
}

TEST(Guard, NamesTheParticleThatIsNotFinite) {
  using enum GuardEvent::Cause;
  expect_fault(fault_after([](Configuration& at) { at.position[3].y() = kNan; }), non_finite, 0, 3);
  expect_fault(fault_after([](Configuration& at) { at.velocity[10].z() = kNan; }), non_finite, 1,
               2);
  expect_fault(fault_after([](Configuration& at) {
                 at.velocity[9].x() = -std::numeric_limits<Real>::infinity();
               }),
               non_finite, 1, 1);
}

TEST(Guard, NamesTheRigidBodyThatIsNotFinite) {
  using enum GuardEvent::Cause;
  const auto expect = [](const auto& spoil) {
    expect_fault(fault_after([&](Configuration& at) { spoil(at.rigid[0]); }), non_finite, 2, 0);
  };
  expect([](RigidState& rigid) { rigid.center_of_mass.z() = kNan; });
  expect([](RigidState& rigid) { rigid.momentum.x() = kNan; });
  expect([](RigidState& rigid) { rigid.angular_momentum.y() = kNan; });
  expect([](RigidState& rigid) { rigid.orientation.w() = kNan; });
}

TEST(Guard, FindsParticlesOutsideTheDomain) {
  using enum GuardEvent::Cause;
  expect_fault(fault_after([](Configuration& at) { at.position[8].x() = -1.1e6; }), outside_domain,
               1, 0);
  expect_fault(fault_after([](Configuration& at) { at.rigid[0].center_of_mass.z() = 1.1e6; }),
               outside_domain, 2, 0);
}

// The runner starts with the last blocks.
TEST(Guard, FindsTheFirstOfManyForAnyThreads) {
  using enum GuardEvent::Cause;
  Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, kStep);
  scene.bodies = {make_block("liquid", BodyKind::liquid, "a", 12, {0, 0, 0.5}, Vec3::Zero())};
  ForceProbe probe(scene);
  Configuration& at = probe.state().now;
  ASSERT_GT(at.position.size(), 6 * kBlockSize);
  const GuardBounds bounds = guard_bounds(probe.model());
  for (const std::size_t threads : {1, 2, 4}) {
    ThreadRunner runner(threads);
    EXPECT_FALSE(find_fault(probe.model(), at, bounds, kStep, &runner)) << threads;
  }
  for (const std::size_t bad : {2 * kBlockSize + 7, 2 * kBlockSize + 9, 5 * kBlockSize}) {
    at.position[bad].x() = kNan;
  }
  for (const std::size_t threads : {1, 2, 4}) {
    ThreadRunner runner(threads);
    expect_fault(find_fault(probe.model(), at, bounds, kStep, &runner), non_finite, 0,
                 2 * kBlockSize + 7);
  }
}

TEST(Guard, TheDomainOfAVatIsTwiceItsLongestSideAroundIt) {
  Scene scene = make_three_kinds();
  scene.vat = Vat{{-1, -1, 0}, {3, 1, 1}, true, SlideMotion{{1, 0, 0}, 0.5, 1}};
  const ForceProbe closed(scene);
  const GuardBounds bounds = guard_bounds(closed.model());
  EXPECT_EQ(bounds.min, Vec3(-9.5, -9.5, -8.5));
  EXPECT_EQ(bounds.max, Vec3(11.5, 9.5, 9.5));
  scene.vat->lid = false;
  const ForceProbe open(scene);
  EXPECT_EQ(guard_bounds(open.model()).max, Vec3(11.5, 9.5, 401));
}

// Particles detect each other at 0.05 m, walls at 0.025 m.
TEST(Guard, AParticleMayNotCrossAWallInOneStep) {
  using enum GuardEvent::Cause;
  Scene scene = make_three_kinds();
  const ForceProbe free(scene);
  EXPECT_EQ(guard_bounds(free.model()).travel, std::vector<Real>(3, 0.05));
  scene.vat = Vat{{-1, -1, 0}, {3, 1, 1}, true, {}};
  const ForceProbe inside(scene);
  EXPECT_EQ(guard_bounds(inside.model()).travel, std::vector<Real>(3, 0.025));
  const auto with_speed = [](Real speed) {
    return fault_after([=](Configuration& at) { at.velocity[2] = {0, speed, 0}; });
  };
  EXPECT_FALSE(with_speed(49.9).has_value());
  expect_fault(with_speed(50.1), too_fast, 0, 2);
  expect_fault(fault_after([](Configuration& at) {
                 at.rigid[0].momentum = {0, 50.1, 0};
               }),
               too_fast, 2, 0);
}

/// Returns the travel limit of each body. A body has two particles of radius 0.025 m.
std::vector<Real> travel_of(const std::vector<std::pair<BodyKind, std::string>>& bodies,
                            bool self_contact = true) {
  Scene scene = make_three_kinds();
  if (!self_contact) {
    for (Material& material : scene.materials) material.self_contact.reset();
  }
  scene.bodies.clear();
  for (const auto& [kind, material] : bodies) {
    const auto count = static_cast<Real>(scene.bodies.size());
    scene.bodies.push_back(make_block("body " + std::to_string(scene.bodies.size()), kind, material,
                                      2, {count, 0, 0}, Vec3::Zero()));
  }
  const ForceProbe probe(scene);
  return guard_bounds(probe.model()).travel;
}

// Liquids of one material interact through their densities, so contact laws do not limit their
// travel.
TEST(Guard, OnlyLiquidsOfOneMaterialDoNotNoticeOneAnother) {
  using enum BodyKind;
  const std::vector<Real> free{kMaxLength, kMaxLength};
  const std::vector<Real> noticed{0.05, 0.05};
  EXPECT_EQ(travel_of({{liquid, "a"}, {liquid, "a"}}), free);
  EXPECT_EQ(travel_of({{liquid, "a"}, {liquid, "b"}}), noticed);
  EXPECT_EQ(travel_of({{liquid, "a"}, {rigid, "a"}}), noticed);
  EXPECT_EQ(travel_of({{deformable, "a"}, {liquid, "a"}}, false), noticed);
  EXPECT_EQ(travel_of({{rigid, "a"}, {rigid, "a"}}), noticed);
  EXPECT_EQ(travel_of({{rigid, "a"}, {deformable, "b"}}, false), noticed);
  EXPECT_EQ(travel_of({{rigid, "a"}}), std::vector<Real>{kMaxLength});
}

TEST(Guard, ADeformableBodyWithSelfContactMeetsItself) {
  EXPECT_EQ(travel_of({{BodyKind::deformable, "a"}}), std::vector<Real>{0.05});
  EXPECT_EQ(travel_of({{BodyKind::deformable, "a"}}, false), std::vector<Real>{kMaxLength});
}

/// Returns the fault of a cube that moves at `speed` and turns at `rate` about the same axis. Its
/// corners are 0.0433 m from its centre, and may travel 0.05 m per step.
std::optional<Fault> fault_of_turning_cube(Real speed, Real rate) {
  const ForceProbe probe(make_three_kinds());
  const Mat3 inertia = probe.model().rigid_bodies[0].inertia;
  return fault_after([&](Configuration& at) {
    at.rigid[0].momentum = {0, 0, speed};  // mass 1 kg
    at.rigid[0].angular_momentum = inertia * Vec3(0, 0, rate);
  });
}

TEST(Guard, TheSpeedOfTheTipsOfARigidBodyCounts) {
  const Real corner = std::sqrt(3) * 0.025;
  for (const Real rate : {0.0, 400.0, 900.0}) {
    const Real most = 50 - corner * rate;
    EXPECT_FALSE(fault_of_turning_cube(most - 0.1, rate).has_value());
    expect_fault(fault_of_turning_cube(most + 0.1, rate), GuardEvent::Cause::too_fast, 2, 0);
  }
}

TEST(Guard, ARigidBodyMayTurnByARadianInAStep) {
  EXPECT_FALSE(fault_of_turning_cube(0, 0.999 / kStep).has_value());
  expect_fault(fault_of_turning_cube(0, 1.001 / kStep), GuardEvent::Cause::too_fast, 2, 0);
}

/// A mass on a spring with frequency `omega_dt` / step. Velocity Verlet is stable below 2.
Scene make_oscillator(Real omega_dt, Real step = kStep, Real stretch = 0.1) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, step);
  scene.materials = {make_material("m")};
  ParticleShape shape = make_particles({{0, 0, 0}, {1 + stretch, 0, 0}}, 1);
  shape.fixed = {0};
  BodyDescription body = make_body("oscillator", BodyKind::deformable, "m", shape, 0.01);
  const Real omega = omega_dt / kStep;
  body.springs = {{0, 1, {omega * omega, 0}, 1.0}};
  scene.bodies = {body};
  return scene;
}

TEST(Guard, NoticesAnUnstableOscillator) {
  Simulation simulation = make_simulation(make_oscillator(3));
  const AdvanceReport report = simulation.advance(40);
  ASSERT_FALSE(report.events.empty());
  const GuardEvent& event = report.events[0];
  EXPECT_EQ(event.cause, GuardEvent::Cause::too_fast);
  EXPECT_EQ(event.body, simulation.bodies()[0].id);
  EXPECT_EQ(event.particle, 1U);
  EXPECT_EQ(event.step, kStep);
  EXPECT_LE(velocity_of(simulation, 0, 1).norm(), kMaxSpeed);
}

/// A particle in flight. At 50 m/s it travels 0.05 m per step, the distance at which another
/// particle detects it.
Scene make_flight(Real speed, Real step = kStep) {
  Scene scene = make_two_material_scene(IntegratorId::explicit_euler, step);
  scene.gravity = {0, 0, -9.81};
  scene.bodies = {make_block("fast", BodyKind::liquid, "a", 1, {0, 0, 0}, {speed, 0, 0}),
                  make_block("other", BodyKind::rigid, "b", 1, {9, 9, 9}, Vec3::Zero())};
  return scene;
}

TEST(Guard, RepeatsAStepInTwoFourAndEightParts) {
  for (const auto& [speed, halvings] :
       {std::pair(60.0, 1U), std::pair(150.0, 2U), std::pair(300.0, 3U)}) {
    Simulation simulation = make_simulation(make_flight(speed));
    const AdvanceReport report = simulation.advance(1);
    EXPECT_FALSE(report.failed);
    ASSERT_EQ(report.events.size(), halvings);
    Real step = kStep;
    for (const GuardEvent& event : report.events) {
      EXPECT_EQ(event.cause, GuardEvent::Cause::too_fast);
      EXPECT_EQ(event.step, step);
      EXPECT_EQ(event.time, step);
      EXPECT_TRUE(event.recovered);
      step /= 2;
    }
    EXPECT_EQ(report.steps, halvings + (1U << halvings));
    EXPECT_EQ(simulation.time(), kStep);

    Simulation fine = make_simulation(make_flight(speed, step));
    fine.advance(1U << halvings);
    EXPECT_EQ(position_of(simulation, 0), position_of(fine, 0));
    EXPECT_EQ(velocity_of(simulation, 0), velocity_of(fine, 0));
  }
}

TEST(Guard, KeepsTheLastGoodStateIfHalvingFails) {
  Simulation simulation = make_simulation(make_oscillator(100));
  const std::uint64_t good = simulation.state_hash();
  const AdvanceReport report = simulation.advance(40);
  EXPECT_TRUE(report.failed);
  ASSERT_EQ(report.events.size(), 4U);
  for (const GuardEvent& event : report.events) EXPECT_FALSE(event.recovered);
  EXPECT_EQ(simulation.state_hash(), good);
  EXPECT_EQ(simulation.time(), 0);
  // A command can remove the cause of the fault.
  ASSERT_TRUE(simulation.remove_body(simulation.bodies()[0].id).ok());
  EXPECT_TRUE(simulation.advance(40).events.empty());
}

TEST(Guard, GoesBackToTheStartOfTheCall) {
  Simulation simulation = make_simulation(make_oscillator(20, kStep, 1e-6));
  ASSERT_FALSE(simulation.advance(1).failed);
  const std::uint64_t good = simulation.state_hash();
  EXPECT_TRUE(simulation.advance(40).failed);
  EXPECT_EQ(simulation.state_hash(), good);
  EXPECT_EQ(simulation.time(), kStep);
}

}  // namespace
}  // namespace vat::guard_test
