#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/mixed_scenes.h"
#include "tests/support/same_bits.h"
#include "tests/support/scenes.h"
#include "tests/support/totals.h"

// Friction in motion: closed forms of a block on a floor and on slopes, and what collisions keep.

namespace vat::friction_test {
namespace {

using namespace test;

constexpr Real kFriction = 0.3;
constexpr Real kGravity = 9.81;   // [m/s^2]
constexpr Real kStiffness = 1e5;  // [N/m], on a block of 1 kg
const Real kRate = std::sqrt(kStiffness);

/// A block on a rough floor that bears its weight, gravity turned by `slope` [rad] about y: a free
/// particle, for a rigid one rolls.
Scene make_block_scene(IntegratorId integrator, Real slope, Real speed) {
  Scene scene = make_scene(integrator, 1e-4);
  scene.gravity = kGravity * Vec3(std::sin(slope), 0, -std::cos(slope));
  scene.materials = {make_material("steel")};
  scene.default_interface = {kStiffness, 0.1 * kRate, kFriction};
  scene.vat = Vat{{-10, -10, 0}, {10, 10, 1}, false, {}, {}};
  scene.bodies = {
      make_body("block", BodyKind::deformable, "steel", make_particles({{0, 0, 0}}, 1), 0.05)};
  scene.bodies[0].position.z() = 0.05 + scene.gravity.z() / kStiffness;
  scene.bodies[0].velocity.x() = speed;
  return scene;
}

TEST(Friction, StopsABlockAfterTheWayOfCoulomb) {
  for (const IntegratorId integrator : kIntegrators) {
    for (const StepControl control :
         {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
      if (control == StepControl::local && integrator != IntegratorId::velocity_verlet) continue;
      Scene scene = make_block_scene(integrator, 0, 2);
      scene.numerics.control = control;
      Simulation simulation = make_simulation(scene);
      advance_to(simulation, 1);
      // The speed falls evenly to mu g / rate, then as exp(-rate t); Euler's methods are half a
      // step off, 2 m/s * 5e-5 s.
      const Real way =
          2.0 * 2.0 / (2 * kFriction * kGravity) + kFriction * kGravity / (2 * kRate * kRate);
      EXPECT_NEAR(position_of(simulation, 0).x(), way, 1.1e-4)
          << to_string(integrator) << ", " << to_string(control);
      EXPECT_NEAR(velocity_of(simulation, 0).x(), 0, 1e-12);
    }
  }
}

TEST(Friction, HoldsABlockOnASlopeBelowItsAngleAlone) {
  const Real angle = std::atan(kFriction);
  Simulation holds =
      make_simulation(make_block_scene(IntegratorId::velocity_verlet, 0.99 * angle, 0));
  advance_to(holds, 1);
  EXPECT_NEAR(velocity_of(holds, 0).x(), kGravity * std::sin(0.99 * angle) / kRate, 1e-9);

  for (const Real slope : {1.1 * angle, std::numbers::pi / 6}) {
    Simulation slides = make_simulation(make_block_scene(IntegratorId::velocity_verlet, slope, 0));
    advance_to(slides, 0.5);
    const Real before = velocity_of(slides, 0).x();
    advance_to(slides, 1);
    const Real acceleration = kGravity * (std::sin(slope) - kFriction * std::cos(slope));
    EXPECT_NEAR((velocity_of(slides, 0).x() - before) / 0.5, acceleration, 1e-9);
  }
}

/// Liquid, deformable and rigid blocks that rub against one another in free space.
Scene make_collision(Real damping) {
  Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, 1e-3, 1);
  scene.default_interface = {5000, damping, 0.5};
  scene.bodies = {
      make_block("pool", BodyKind::liquid, "a", 6, {0, 0, 0}, {0, 0, 0}),
      make_block("jelly", BodyKind::deformable, "b", 4, {0.02, 0.01, 0.27}, {0.7, 0.2, -1}),
      make_block("crate", BodyKind::rigid, "b", 4, {0.25, -0.01, 0.03}, {-1, 0.3, 0.8})};
  return scene;
}

TEST(Friction, KeepsMomentumInCollisionsOfEveryKind) {
  for (const StepControl control :
       {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
    for (const Real damping : {0.0, 40.0}) {
      Scene scene = make_collision(damping);
      scene.numerics.control = control;
      Simulation simulation = make_simulation(scene);
      scene.default_interface.friction = 0;
      Simulation smooth = make_simulation(scene);
      const Vec3 before = totals_of(simulation.diagnostics()).momentum;
      const Motion motion = motion_of(simulation);
      EXPECT_EQ(simulation.advance(300).undone_steps, 0U);
      smooth.advance(300);
      EXPECT_LT((totals_of(simulation.diagnostics()).momentum - before).norm(),
                1e-12 * motion.momentum);
      EXPECT_LT(simulation.diagnostics().kinetic_energy, smooth.diagnostics().kinetic_energy);
    }
  }
}

TEST(Friction, KeepsAngularMomentumWhereOneOfTheTwoIsRigid) {
  for (const BodyKind kind : {BodyKind::liquid, BodyKind::deformable, BodyKind::rigid}) {
    for (const Real damping : {0.0, 40.0, 100.0}) {  // the last must be solved for
      Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, 1e-3);
      scene.default_interface = {5000, damping, 0.5};
      scene.bodies = {make_block("a", kind, "a", 3, {-0.09, 0.01, 0.02}, {1, 0.4, 0}),
                      make_block("b", BodyKind::rigid, "b", 3, {0.09, 0, 0}, {-1, 0, 0.3})};
      Simulation simulation = make_simulation(scene);
      scene.default_interface.friction = 0;
      Simulation smooth = make_simulation(scene);
      const Totals before = totals_of(simulation.diagnostics());
      const Motion motion = motion_of(simulation);
      advance_to(simulation, 0.2);
      advance_to(smooth, 0.2);
      const Totals after = totals_of(simulation.diagnostics());
      EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12 * motion.momentum)
          << to_string(kind) << ' ' << damping;
      EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(),
                1e-11 * motion.angular_momentum)
          << to_string(kind) << ' ' << damping;
      EXPECT_GT((velocity_of(simulation, 0) - velocity_of(smooth, 0)).norm(), 0.01);
    }
  }
}

/// A ball on the floor of make_block_scene().
Scene make_ball_scene(Real slope, Real speed) {
  Scene scene = make_block_scene(IntegratorId::velocity_verlet, slope, speed);
  scene.bodies[0].kind = BodyKind::rigid;
  return scene;
}

// A ball that slides rolls at 5/7 of its speed after 2 v / (7 mu g); down a slope it rolls with 5/7
// of the acceleration.
TEST(Friction, SetsABallRolling) {
  for (const StepControl control :
       {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
    Scene scene = make_ball_scene(0, 2);
    scene.numerics.control = control;
    Simulation simulation = make_simulation(scene);
    advance_to(simulation, 0.5);
    const RigidPose pose = *simulation.bodies()[0].pose;
    // The contact is a ball's radius less the overlap from its centre.
    const Real arm = pose.center_of_mass.z();
    EXPECT_NEAR(pose.velocity.x(), 10.0 / 7, 3e-3) << to_string(control);
    EXPECT_NEAR(pose.angular_velocity.y() * arm, pose.velocity.x(), 1e-9) << to_string(control);
  }
  Simulation down = make_simulation(make_ball_scene(0.2, 0));
  advance_to(down, 0.5);
  const Real before = velocity_of(down, 0).x();
  advance_to(down, 1);
  EXPECT_NEAR((velocity_of(down, 0).x() - before) / 0.5, 5.0 / 7 * kGravity * std::sin(0.2), 0.01);
}

/// Velocity of the first of two balls of 1 kg after they have met, off their centres.
Vec3 glance_off(StepControl control, Real step) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, step);
  scene.numerics.control = control;
  scene.materials = {make_material("steel")};
  scene.default_interface = {kStiffness, 0, kFriction};
  const ParticleShape ball = make_particles({{0, 0, 0}}, 1);
  scene.bodies = {make_body("moving", BodyKind::rigid, "steel", ball, 0.1),
                  make_body("resting", BodyKind::rigid, "steel", ball, 0.1)};
  scene.bodies[0].velocity = {1, 0, 1};
  scene.bodies[1].position = {0.21, 0, 0};
  Simulation simulation = make_simulation(scene);
  advance_to(simulation, 0.05);
  return velocity_of(simulation, 0);
}

TEST(Friction, BetweenBodiesIsTheSameWithEveryStepControl) {
  const Vec3 exact = glance_off(StepControl::fixed, 1e-5);
  EXPECT_LT(exact.z(), 0.95);  // of 1 m/s: what friction takes is not small
  for (const StepControl control : {StepControl::adaptive, StepControl::local}) {
    // The tolerance of varied steps, 1 %, of what friction takes.
    EXPECT_NEAR(glance_off(control, 1e-3).z(), exact.z(), 0.01 * (1 - exact.z()))
        << to_string(control);
  }
}

TEST(Friction, GivesTheSameBitsForAnyThreadsAndFromASnapshot) {
  expect_same_bits(make_collision(2), 60, 40);
}

/// A belt takes a block that is set on it along at its own speed.
TEST(Friction, OfAMovingWallTakesABlockAlong) {
  Scene scene = make_block_scene(IntegratorId::velocity_verlet, 0, 0);
  scene.vat->walls[4].velocity = {0, 1.5, 0};
  Simulation simulation = make_simulation(scene);
  advance_to(simulation, 0.4);
  EXPECT_NEAR(velocity_of(simulation, 0).y(), 0.4 * kFriction * kGravity, 1e-9);
  advance_to(simulation, 1);
  EXPECT_NEAR(velocity_of(simulation, 0).y(), 1.5, 1e-12);
}

}  // namespace
}  // namespace vat::friction_test
