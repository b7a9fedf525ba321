#include "core/guard/guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/limits.h"
#include "tests/support/force_probe.h"
#include "tests/support/mixed_scenes.h"
#include "tests/support/thread_runner.h"

namespace vat::test::guard_test {
namespace {

using enum GuardEvent::Cause;

constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
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

TEST(Guard, NamesTheParticleOrBodyWithAFault) {
  struct Case {
    std::function<void(Configuration&)> spoil;
    GuardEvent::Cause cause;
    Index body;
    Index particle;
  };
  const Case cases[] = {
      {[](Configuration& at) { at.position[3].y() = kNan; }, non_finite, 0, 3},
      {[](Configuration& at) { at.velocity[10].z() = kNan; }, non_finite, 1, 2},
      {[](Configuration& at) { at.velocity[9].x() = -kInfinity; }, non_finite, 1, 1},
      {[](Configuration& at) { at.rigid[0].center_of_mass.z() = kNan; }, non_finite, 2, 0},
      {[](Configuration& at) { at.rigid[0].momentum.x() = kNan; }, non_finite, 2, 0},
      {[](Configuration& at) { at.rigid[0].angular_momentum.y() = kNan; }, non_finite, 2, 0},
      {[](Configuration& at) { at.rigid[0].orientation.w() = kNan; }, non_finite, 2, 0},
      {[](Configuration& at) { at.position[8].x() = -1.1e6; }, outside_domain, 1, 0},
      {[](Configuration& at) { at.rigid[0].center_of_mass.z() = 1.1e6; }, outside_domain, 2, 0},
      {[](Configuration& at) { at.velocity[2].y() = 50.1; }, too_fast, 0, 2},
      {[](Configuration& at) { at.rigid[0].momentum.y() = 50.1; }, too_fast, 2, 0}};
  for (const Case& one : cases) {
    SCOPED_TRACE(&one - cases);
    expect_fault(fault_after(one.spoil), one.cause, one.body, one.particle);
  }
  EXPECT_FALSE(fault_after([](Configuration& at) { at.velocity[2].y() = 49.9; }));
}

// The runner starts with the last blocks.
TEST(Guard, FindsTheFirstOfManyForAnyThreads) {
  Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, kStep);
  scene.bodies = {make_block("liquid", BodyKind::liquid, "a", 12, {0, 0, 0.5}, Vec3::Zero())};
  ForceProbe probe(scene);
  Configuration& at = probe.state().now;
  ASSERT_GT(at.position.size(), 6 * kBlockSize);
  const GuardBounds bounds = guard_bounds(probe.model());
  for (const std::size_t threads : {1U, 2U, 4U}) {
    ThreadRunner runner(threads);
    EXPECT_FALSE(find_fault(probe.model(), at, bounds, kStep, &runner)) << threads;
  }
  for (const std::size_t bad : {2 * kBlockSize + 7, 2 * kBlockSize + 9, 5 * kBlockSize}) {
    at.position[bad].x() = kNan;
  }
  for (const std::size_t threads : {1U, 2U, 4U}) {
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
TEST(Guard, LimitsTheTravelInAStepToTheReachOfWallsAndParticles) {
  Scene scene = make_three_kinds();
  const ForceProbe free(scene);
  EXPECT_EQ(guard_bounds(free.model()).travel, std::vector<Real>(3, 0.05));
  scene.vat = Vat{{-1, -1, 0}, {3, 1, 1}, true, {}};
  const ForceProbe inside(scene);
  EXPECT_EQ(guard_bounds(inside.model()).travel, std::vector<Real>(3, 0.025));
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
    expect_fault(fault_of_turning_cube(most + 0.1, rate), too_fast, 2, 0);
  }
}

TEST(Guard, ARigidBodyMayTurnByARadianInAStep) {
  EXPECT_FALSE(fault_of_turning_cube(0, 0.999 / kStep).has_value());
  expect_fault(fault_of_turning_cube(0, 1.001 / kStep), too_fast, 2, 0);
}

TEST(Guard, KeepsTheLastGoodStateIfHalvingFails) {
  const Real omega = 100 / kStep;  // velocity Verlet is stable below 2 / kStep
  Simulation simulation = make_simulation(
      make_oscillator(IntegratorId::velocity_verlet, kStep, {omega * omega, 0}, 1.1));
  const std::uint64_t good = simulation.state_hash();
  const AdvanceReport report = simulation.advance(40);
  EXPECT_TRUE(report.failed);
  ASSERT_EQ(report.events.size(), 4U);
  for (const GuardEvent& event : report.events) {
    EXPECT_EQ(event.cause, too_fast);
    EXPECT_EQ(event.particle, 1U);
    EXPECT_FALSE(event.recovered);
  }
  EXPECT_EQ(simulation.state_hash(), good);
  EXPECT_EQ(simulation.time(), 0);
  // A command can remove the cause of the fault.
  ASSERT_TRUE(simulation.remove_body(simulation.bodies()[0].id).ok());
  EXPECT_TRUE(simulation.advance(40).events.empty());
}

// In one step, a particle at 50 m/s travels 0.05 m, the distance at which another particle detects
// it. It needs two parts above 50 m/s, four above 100 m/s and eight above 200 m/s. Above 400 m/s
// the guard reports a failure.

/// A particle in flight, and a distant body that it could meet. The speed increases by 1 m/s per
/// step.
Scene make_flight(Real speed, IntegratorId integrator = IntegratorId::explicit_euler) {
  Scene scene = make_two_material_scene(integrator, kStep);
  scene.gravity = {1000, 0, 0};
  scene.bodies = {make_block("fast", BodyKind::liquid, "a", 1, {0, 0, 0}, {speed, 0, 0}),
                  make_block("other", BodyKind::rigid, "b", 1, {9, 9, 9}, Vec3::Zero())};
  return scene;
}

/// A scene in which the guard divides some steps only. The crate's corners turn at 1.6 m/s, so the
/// 9th step is the first with two parts, and the 59th the first with four.
Scene make_flight_and_crowd(IntegratorId integrator) {
  Scene scene = make_flight(39.5, integrator);
  scene.bodies[1].position = {0, 9, 9};
  scene.bodies.push_back(
      make_block("jelly", BodyKind::deformable, "b", 3, {0, 0.5, 0}, {39.5, 0, 0}));
  scene.bodies.push_back(make_block("crate", BodyKind::rigid, "a", 2, {0, 0.62, 0}, {39.5, 0, 0}));
  scene.bodies.back().angular_velocity = {10, -20, 30};
  return scene;
}

TEST(GuardRun, GivesTheSameBitsForAnyCalls) {
  constexpr std::uint32_t kSteps = 80;
  for (const IntegratorId integrator : kIntegrators) {
    Simulation whole = make_simulation(make_flight_and_crowd(integrator));
    Simulation tens = make_simulation(make_flight_and_crowd(integrator));
    Simulation ones = make_simulation(make_flight_and_crowd(integrator));
    const AdvanceReport report = whole.advance(kSteps);
    EXPECT_EQ(report.undone_steps, 50U + 2 * 22U) << to_string(integrator);
    std::uint64_t undone = 0;
    for (std::uint32_t n = 0; n < kSteps / 10; ++n) undone += tens.advance(10).undone_steps;
    EXPECT_EQ(undone, report.undone_steps) << to_string(integrator);
    for (std::uint32_t n = 0; n < kSteps; ++n) ones.advance(1);
    EXPECT_EQ(tens.state_hash(), whole.state_hash()) << to_string(integrator);
    EXPECT_EQ(ones.state_hash(), whole.state_hash()) << to_string(integrator);
    EXPECT_EQ(ones.time(), whole.time());
  }
}

// The forces at the end of an undone step belong to a stretched spring. The replacing step must not
// use them. Without damping the forces do not depend on the velocity, so the result equals a run
// with half the step.
TEST(GuardRun, NothingIsLeftOfAnUndoneStep) {
  Scene scene = make_flight(60, IntegratorId::velocity_verlet);
  BodyDescription pair = make_body("pair", BodyKind::deformable, "b",
                                   make_particles({{0, 1, 0}, {0, 1.3, 0}}, 0.1), 0.025);
  pair.velocity = {60, 0, 0};
  pair.springs = {{0, 1, {1000, 0}, 0.2}};
  scene.bodies.push_back(pair);
  Scene fine_scene = scene;
  fine_scene.numerics.step = fine_scene.numerics.tick = kStep / 2;
  Simulation simulation = make_simulation(scene);
  Simulation fine = make_simulation(fine_scene);
  EXPECT_EQ(simulation.advance(20).undone_steps, 20U);
  EXPECT_EQ(fine.advance(40).undone_steps, 0U);
  EXPECT_EQ(position_of(simulation, 2, 1), position_of(fine, 2, 1));
  EXPECT_EQ(velocity_of(simulation, 2, 1), velocity_of(fine, 2, 1));
}

// A part of length h fails if its final speed exceeds 0.05 m / h. Every part adds 1000 m/s^2 h.
TEST(GuardRun, AnEventIsAtTheEndOfTheFailedPart) {
  Simulation simulation = make_advanced(make_flight(196.375), 3);
  const AdvanceReport report = simulation.advance(1);  // from 199.375 m/s
  EXPECT_FALSE(report.failed);
  ASSERT_EQ(report.events.size(), 3U);
  const Real start = 3 * kStep;
  // The first half fails. Of the quarters, the third fails: it ends at 200.125 m/s.
  const Real ends[] = {start + kStep, start + kStep / 2, start + 3 * kStep / 4};
  Real length = kStep;
  for (std::size_t e = 0; e < 3; ++e) {
    EXPECT_EQ(report.events[e].cause, too_fast);
    EXPECT_EQ(report.events[e].body, simulation.bodies()[0].id);
    EXPECT_EQ(report.events[e].particle, 0U);
    EXPECT_DOUBLE_EQ(report.events[e].time, ends[e]);
    EXPECT_EQ(report.events[e].step, length);
    EXPECT_TRUE(report.events[e].recovered);
    length /= 2;
  }
  EXPECT_EQ(report.undone_steps, 3U);
  EXPECT_EQ(report.steps, 1U + 1U + 3U + 8U);
  EXPECT_DOUBLE_EQ(simulation.time(), 4 * kStep);
  EXPECT_NEAR(velocity_of(simulation, 0).x(), 196.375 + 4, 1e-12);
}

TEST(GuardRun, CountsAllEventsAndKeepsTheFirstAndTheLast) {
  constexpr std::size_t kMax = AdvanceReport::kMaxEvents;
  Simulation simulation = make_simulation(make_flight(105));
  const AdvanceReport report = simulation.advance(20);
  EXPECT_FALSE(report.failed);
  EXPECT_EQ(report.undone_steps, 40U);
  EXPECT_EQ(report.steps, 20 * (1U + 1U + 4U));
  ASSERT_EQ(report.events.size(), kMax);
  for (std::size_t e = 0; e + 1 < kMax; ++e) {
    const std::size_t step = e / 2;  // two events per step
    EXPECT_DOUBLE_EQ(report.events[e].time,
                     (static_cast<Real>(step) + (e % 2 == 0 ? 1 : 0.5)) * kStep);
    EXPECT_EQ(report.events[e].step, e % 2 == 0 ? kStep : kStep / 2);
  }
  EXPECT_DOUBLE_EQ(report.events.back().time, 19.5 * kStep);
  EXPECT_EQ(report.events.back().step, kStep / 2);
  EXPECT_TRUE(report.events.back().recovered);
}

TEST(GuardRun, OfACallThatFailsAfterManyEventsTheLastIsNotRecovered) {
  Simulation simulation = make_simulation(make_flight(390.5));
  const std::uint64_t start = simulation.state_hash();
  const AdvanceReport report = simulation.advance(20);  // the tenth reaches 400.5 m/s
  EXPECT_TRUE(report.failed);
  EXPECT_EQ(report.undone_steps, 9 * 3U + 4U);
  ASSERT_EQ(report.events.size(), AdvanceReport::kMaxEvents);
  EXPECT_TRUE(report.events.front().recovered);
  EXPECT_FALSE(report.events.back().recovered);
  EXPECT_EQ(report.events.back().step, kStep / 8);
  EXPECT_EQ(simulation.state_hash(), start);
}

/// A ball of 0.1 m at 1 m/s, and two grains of `radius` at rest.
Scene make_ball_and_grains(Real radius) {
  Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, kStep);
  scene.bodies = {
      make_body("ball", BodyKind::rigid, "a", make_particles({{0, 0, 0}}, 1), 0.1),
      make_body("grain", BodyKind::rigid, "a", make_particles({{0.5, 2, 0}}, 1e-6), radius),
      make_body("other grain", BodyKind::deformable, "b", make_particles({{0.5, 3, 0}}, 1e-6),
                radius)};
  scene.bodies[0].velocity = {1, 0, 0};
  return scene;
}

// A step moves the ball by 1 mm, which is ten radii of a grain, but a hundredth of the ball's
// contact distance.
TEST(GuardRun, AGrainAtRestDoesNotLimitABall) {
  Simulation simulation = make_simulation(make_ball_and_grains(1e-4));
  EXPECT_EQ(simulation.advance(1000).undone_steps, 0U);
  EXPECT_NEAR(position_of(simulation, 0).x(), 1, 1e-12);
}

// Two grains detect each other at 0.2 mm.
TEST(GuardRun, AGrainIsLimitedByAnotherGrain) {
  Scene scene = make_ball_and_grains(1e-4);
  scene.bodies[1].velocity = {0.3, 0, 0};
  Simulation simulation = make_simulation(scene);
  const AdvanceReport report = simulation.advance(1);
  ASSERT_EQ(report.events.size(), 1U);
  EXPECT_EQ(report.events[0].cause, too_fast);
  EXPECT_EQ(report.events[0].body, simulation.bodies()[1].id);
}

}  // namespace
}  // namespace vat::test::guard_test
