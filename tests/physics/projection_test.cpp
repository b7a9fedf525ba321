#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/mixed_scenes.h"
#include "tests/support/same_bits.h"
#include "tests/support/scenes.h"
#include "tests/support/thread_runner.h"
#include "tests/support/totals.h"

// Contacts by projection, at steps of a display's frame and longer.

namespace vat::projection_test {
namespace {

using namespace test;

constexpr Real kGravity = 9.81;  // [m/s^2]
constexpr Real kFrame = 1.0 / 60;
constexpr Real kRadius = 0.05;  // [m]

InterfaceConstants projection(Real friction = 0, Real restitution = 0) {
  return {.friction = friction, .law = InterfaceLaw::projection, .restitution = restitution};
}

/// A floor, and gravity turned by `slope` [rad] about y.
Scene make_floor_scene(Real step, Real slope = 0) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, step);
  scene.gravity = kGravity * Vec3(std::sin(slope), 0, -std::cos(slope));
  scene.materials = {make_material("steel")};
  scene.vat = Vat{{-20, -20, 0}, {20, 20, 20}, false, {}, {}};
  return scene;
}

BodyDescription make_ball(const std::string& name, const Vec3& position) {
  BodyDescription ball =
      make_body(name, BodyKind::rigid, "steel", make_particles({{0, 0, 0}}, 1), kRadius);
  ball.position = position;
  return ball;
}

/// A block that stands on a face of 4 x 4 particles.
BodyDescription make_plate(const std::string& name, Real height) {
  BodyDescription block =
      make_body(name, BodyKind::rigid, "steel",
                make_particles(make_lattice(4, 4, 2, 2 * kRadius), 0.5), kRadius);
  block.position.z() = height;
  return block;
}

Real height_of(const Simulation& simulation, std::size_t body = 0) {
  return simulation.bodies()[body].pose->center_of_mass.z();
}

constexpr IntegratorId kAllowed[] = {IntegratorId::velocity_verlet, IntegratorId::symplectic_euler};

TEST(Projection, PartsWithTheRestitutionAtAnyStep) {
  for (const IntegratorId integrator : kAllowed) {
    for (const Real step : {kFrame, 1.0 / 240, 1e-3}) {
      for (const Real e : {0.0, 0.3, 0.7, 1.0}) {
        Scene scene = make_floor_scene(step);
        scene.gravity.setZero();
        scene.numerics.integrator = integrator;
        scene.default_interface = projection(0, e);
        scene.bodies = {make_ball("ball", {0, 0, 0.3})};
        scene.bodies[0].velocity = {0.5, 0, -2};
        Simulation simulation = make_simulation(scene);
        advance_to(simulation, step * std::ceil(0.3 / step));
        EXPECT_NEAR(velocity_of(simulation, 0).z(), 2 * e, 1e-12) << step;
        EXPECT_NEAR(velocity_of(simulation, 0).x(), 0.5, 1e-12);
      }
    }
  }
}

TEST(Projection, RisesAsHighAsItsRestitutionSaysToTheFirstOrder) {
  for (const Real e : {0.5, 1.0}) {
    Real last = 1;
    for (const Real step : {8e-3, 4e-3, 2e-3, 1e-3}) {
      Scene scene = make_floor_scene(step);
      scene.default_interface = projection(0, e);
      scene.bodies = {make_ball("ball", {0, 0, kRadius + 1})};
      Simulation simulation = make_simulation(scene);
      advance_to(simulation, step * std::round(0.46 / step));
      Real highest = 0;
      while (velocity_of(simulation, 0).z() > 0) {
        simulation.advance(1);
        highest = std::max(highest, height_of(simulation) - kRadius);
      }
      const Real speed = std::sqrt(2 * kGravity);
      // The bounce is at the end of a step: up to g dt too fast or dt v too high.
      EXPECT_NEAR(highest, e * e, 2 * e * e * speed * step) << step;
      last = highest;
    }
    EXPECT_NEAR(last, e * e, 0.01 * e * e);
  }
}

TEST(Projection, ExchangesVelocitiesInALineOfBalls) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, kFrame);
  scene.materials = {make_material("steel")};
  scene.default_interface = projection(0, 1);
  scene.bodies = {make_ball("a", {-0.5, 0, 0}), make_ball("b", {0, 0, 0})};
  scene.bodies[0].velocity.x() = 2;
  Simulation simulation = make_simulation(scene);
  advance_to(simulation, 60 * kFrame);
  EXPECT_NEAR(velocity_of(simulation, 0).x(), 0, 1e-12);
  EXPECT_NEAR(velocity_of(simulation, 1).x(), 2, 1e-12);
}

/// Bodies of all kinds that fly together, turn, and touch at many points.
Scene make_crowd(BodyKind first, BodyKind second) {
  Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, 4e-3);
  scene.default_interface = projection(0.4, 0.3);
  scene.bodies = {make_block("a", first, "a", 3, {-0.09, 0.01, 0.02}, {1, 0.4, 0}),
                  make_block("b", second, "b", 3, {0.09, 0, 0}, {-1, 0, 0.3})};
  return scene;
}

TEST(Projection, KeepsMomentumAndAngularMomentumOfEveryPairing) {
  for (const IntegratorId integrator : kAllowed) {
    for (const BodyKind first : {BodyKind::liquid, BodyKind::deformable, BodyKind::rigid}) {
      for (const BodyKind second : {BodyKind::liquid, BodyKind::deformable, BodyKind::rigid}) {
        Scene scene = make_crowd(first, second);
        scene.numerics.integrator = integrator;
        // Friction between two free particles has a couple, for they have no spin that takes it.
        const bool can_spin = first == BodyKind::rigid || second == BodyKind::rigid;
        if (!can_spin) scene.default_interface.friction = 0;
        // Damped springs and liquids keep it too, but for the liquid's viscosity, here zero.
        Simulation simulation = make_simulation(scene);
        const Totals before = totals_of(simulation.diagnostics());
        const Motion motion = motion_of(simulation);
        const Vec3 velocity = velocity_of(simulation, 0);
        advance_to(simulation, 0.2);
        const Totals after = totals_of(simulation.diagnostics());
        EXPECT_GT((velocity_of(simulation, 0) - velocity).norm(), 0.1);
        EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12 * motion.momentum)
            << to_string(first) << " and " << to_string(second);
        EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(),
                  1e-11 * motion.angular_momentum)
            << to_string(first) << " and " << to_string(second);
      }
    }
  }
}

TEST(Projection, NeverGainsEnergyInACollision) {
  for (const Real step : {1e-3, 4e-3, kFrame, 0.05}) {
    Scene scene = make_crowd(BodyKind::rigid, BodyKind::rigid);
    scene.numerics.step = scene.numerics.tick = step;
    Simulation simulation = make_simulation(scene);
    const Real before = simulation.diagnostics().kinetic_energy;
    simulation.advance(static_cast<std::uint32_t>(std::ceil(0.3 / step)));
    const Real after = simulation.diagnostics().kinetic_energy;
    EXPECT_LT(after, before) << step;
    EXPECT_GT(after, 0.05 * before) << step;
  }
}

TEST(Projection, StopsABlockAfterTheWayOfCoulomb) {
  constexpr Real kFriction = 0.3;
  for (const Real step : {kFrame, 1e-3}) {
    Scene scene = make_floor_scene(step);
    scene.default_interface = projection(kFriction);
    scene.bodies = {make_plate("block", 2 * kRadius)};
    scene.bodies[0].velocity.x() = 2;
    Simulation simulation = make_simulation(scene);
    advance_to(simulation, step * std::ceil(1 / step));
    const Real way = 2.0 * 2.0 / (2 * kFriction * kGravity);
    // Even deceleration is exact; the last step stops it within the step.
    EXPECT_NEAR(simulation.bodies()[0].pose->center_of_mass.x(), way,
                kFriction * kGravity * step * step + 1e-6);
    EXPECT_LT(velocity_of(simulation, 0).norm(), 1e-5);
  }
}

TEST(Projection, HoldsABlockOnASlopeWithoutCreep) {
  constexpr Real kFriction = 0.5;
  const Real angle = std::atan(kFriction);
  for (const Real share : {0.5, 0.97}) {
    Scene scene = make_floor_scene(kFrame, share * angle);
    scene.default_interface = projection(kFriction);
    scene.bodies = {make_plate("block", 2 * kRadius)};
    Simulation simulation = make_simulation(scene);
    advance_to(simulation, 60 * kFrame);
    const Vec3 settled = position_of(simulation, 0);
    advance_to(simulation, 60 * 60 * kFrame);
    EXPECT_LT((position_of(simulation, 0) - settled).norm(), 1e-6) << share;
  }
  Scene scene = make_floor_scene(kFrame, 1.2 * angle);
  scene.default_interface = projection(kFriction);
  scene.bodies = {make_plate("block", 2 * kRadius)};
  Simulation simulation = make_simulation(scene);
  advance_to(simulation, 30 * kFrame);
  const Real pull = scene.gravity.x() + kFriction * scene.gravity.z();
  EXPECT_NEAR(velocity_of(simulation, 0).x(), 30 * kFrame * pull, 1e-3 * pull);
}

// A ball that slides begins to roll at 5/7 of its speed, after 2 v / (7 mu g).
TEST(Projection, SetsASlidingBallRolling) {
  constexpr Real kFriction = 0.3;
  for (const Real step : {1e-3, kFrame}) {
    Scene scene = make_floor_scene(step);
    scene.default_interface = projection(kFriction);
    scene.bodies = {make_ball("ball", {0, 0, kRadius})};
    scene.bodies[0].velocity.x() = 2;
    Simulation simulation = make_simulation(scene);
    advance_to(simulation, step * std::ceil(0.5 / step));
    const RigidPose pose = *simulation.bodies()[0].pose;
    EXPECT_NEAR(pose.velocity.x(), 10.0 / 7, 1e-5) << step;
    EXPECT_NEAR(pose.angular_velocity.y(), 10.0 / 7 / kRadius, 1e-3) << step;
  }
}

TEST(Projection, BearsAStackAtAnyStep) {
  for (const Real step : {0.05, kFrame, 1e-3}) {
    Scene scene = make_floor_scene(step);
    scene.default_interface = projection(0.5);
    for (int i = 0; i < 5; ++i) {
      scene.bodies.push_back(make_plate("plate " + std::to_string(i), (2 + 4 * i) * kRadius));
    }
    Simulation simulation = make_simulation(scene);
    const AdvanceReport report = simulation.advance(300);
    EXPECT_TRUE(report.events.empty());
    for (int i = 0; i < 5; ++i) {
      EXPECT_NEAR(height_of(simulation, static_cast<std::size_t>(i)), (2 + 4 * i) * kRadius, 1e-4)
          << step;
    }
    EXPECT_LT(simulation.diagnostics().kinetic_energy, 1e-4);
  }
}

TEST(Projection, PutsApartWhatOverlapsAtTheStartWithoutThrowingIt) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, kFrame);
  scene.materials = {make_material("steel")};
  scene.default_interface = projection();
  scene.bodies = {make_plate("a", 0), make_plate("b", 3.1 * kRadius)};
  Simulation simulation = make_simulation(scene);
  advance_to(simulation, 60 * kFrame);
  EXPECT_NEAR(height_of(simulation, 1) - height_of(simulation, 0), 4 * kRadius, 1e-5);
  EXPECT_LT(simulation.diagnostics().kinetic_energy, 1e-8);
}

TEST(Projection, CarriesWhatStandsOnAVatThatSlides) {
  Scene scene = make_floor_scene(kFrame);
  scene.default_interface = projection(0.8);
  scene.vat->motion = SlideMotion{{1, 0, 0}, 0.4, 2};  // at most 2 m/s^2
  scene.bodies = {make_plate("block", 2 * kRadius)};
  Simulation simulation = make_simulation(scene);
  advance_to(simulation, 60 * kFrame);
  EXPECT_NEAR(position_of(simulation, 0).x() + 3 * kRadius, 0.4, 1e-5);
}

TEST(Projection, HasTheSameBitsOnAnyNumberOfThreads) {
  Scene scene = make_crowd(BodyKind::rigid, BodyKind::deformable);
  scene.bodies.push_back(make_block("c", BodyKind::rigid, "a", 6, {0, 0.3, 0}, {0, -1, 0}));
  Simulation alone = make_simulation(scene);
  ThreadRunner runner(3);
  Simulation together = make_simulation(scene, &runner);
  alone.advance(60);
  together.advance(60);
  EXPECT_EQ(alone.state_hash(), together.state_hash());
  const Snapshot snapshot = alone.snapshot();
  alone.advance(10);
  const std::uint64_t hash = alone.state_hash();
  alone.restore(snapshot);
  alone.advance(10);
  EXPECT_EQ(alone.state_hash(), hash);
}

TEST(Projection, OfTooManyContactsFailsTheStep) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, kFrame);
  scene.materials = {make_material("steel")};
  scene.default_interface = projection();
  std::vector<Vec3> points;
  for (int i = 0; i < 750; ++i) points.emplace_back(1e-5 * i, 0, 0);  // 562 500 pairs
  for (const char* name : {"a", "b"}) {
    scene.bodies.push_back(
        make_body(name, BodyKind::deformable, "steel", make_particles(points, 1e-3), kRadius));
  }
  Simulation simulation = make_simulation(scene);
  const std::uint64_t before = simulation.state_hash();
  const AdvanceReport report = simulation.advance(1);
  EXPECT_TRUE(report.failed);
  EXPECT_EQ(report.events.at(0).cause, GuardEvent::Cause::too_many_pairs);
  EXPECT_EQ(simulation.state_hash(), before);
}

TEST(Projection, DoesNotLimitAdaptiveSteps) {
  Scene scene = make_floor_scene(kFrame);
  scene.default_interface = projection(0.5);
  scene.numerics.control = StepControl::adaptive;
  scene.bodies = {make_plate("block", 2 * kRadius)};
  Simulation simulation = make_simulation(scene);
  EXPECT_EQ(simulation.advance(60).steps, 60U);
}

// Where no contact is by a force, the solve for damping has none to ask for.
TEST(Projection, GoesWithDashpotsThatStepsDoNotResolve) {
  Scene scene = make_floor_scene(kFrame);
  scene.default_interface = projection();
  scene.bodies = {make_body("dumbbell", BodyKind::deformable, "steel",
                            make_particles({{0, 0, 0.1}, {0.3, 0, 0.1}}, 1), kRadius),
                  make_ball("ball", {0, 0, 0.25})};
  scene.bodies[0].springs = {{0, 1, {10, 1e4}, {}}};
  Simulation simulation = make_simulation(scene);
  const AdvanceReport report = simulation.advance(60);
  EXPECT_TRUE(report.events.empty());
  for (const Index particle : {0U, 1U}) {
    EXPECT_NEAR(position_of(simulation, 0, particle).z(), kRadius, 1e-9);
  }
  EXPECT_GT(height_of(simulation, 1), kRadius - 1e-9);
}

}  // namespace
}  // namespace vat::projection_test
