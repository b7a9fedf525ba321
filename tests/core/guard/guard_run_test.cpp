#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/mixed_scenes.h"

// Effects of the guard on a run: the resulting bits, and the contents of the report.

namespace vat::guard_run_test {
namespace {

using namespace test;
using enum GuardEvent::Cause;

constexpr Real kStep = 1e-3;
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
  Simulation simulation = make_simulation(make_flight(196.375));
  simulation.advance(3);
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
}  // namespace vat::guard_run_test
