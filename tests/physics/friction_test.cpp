#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/mixed_scenes.h"
#include "tests/support/same_bits.h"

// Friction during motion with every integrator and step control. RIG-7 compares it with closed
// forms.

namespace vat::friction_test {
namespace {

using namespace test;

constexpr Real kFriction = 0.3;
constexpr Real kGravity = 9.81;   // [m/s^2]
constexpr Real kStiffness = 1e5;  // [N/m] for a block of 1 kg
const Real kRate = std::sqrt(kStiffness);

/// A sliding block on a rough floor. It is a free particle, because a rigid particle would roll.
Scene make_block_scene(IntegratorId integrator) {
  Scene scene = make_scene(integrator, 1e-4);
  scene.gravity = {0, 0, -kGravity};
  scene.materials = {make_material("steel")};
  scene.default_interface = {kStiffness, 0.1 * kRate, kFriction};
  scene.vat = Vat{{-10, -10, 0}, {10, 10, 1}, false, {}, {}};
  scene.bodies = {
      make_body("block", BodyKind::deformable, "steel", make_particles({{0, 0, 0}}, 1), 0.05)};
  scene.bodies[0].position.z() = 0.05 + scene.gravity.z() / kStiffness;
  scene.bodies[0].velocity.x() = 2;
  return scene;
}

TEST(Friction, StopsABlockAfterTheWayOfCoulomb) {
  for (const IntegratorId integrator : kIntegrators) {
    for (const StepControl control :
         {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
      if (control == StepControl::local && integrator != IntegratorId::velocity_verlet) continue;
      Scene scene = make_block_scene(integrator);
      scene.numerics.control = control;
      Simulation simulation = make_simulation(scene);
      advance_to(simulation, 1);
      // The speed decreases linearly to mu g / rate, then as exp(-rate t). The Euler methods differ
      // by half a step, 2 m/s * 5e-5 s.
      const Real way =
          2.0 * 2.0 / (2 * kFriction * kGravity) + kFriction * kGravity / (2 * kRate * kRate);
      EXPECT_NEAR(position_of(simulation, 0).x(), way, 1.1e-4)
          << to_string(integrator) << ", " << to_string(control);
      EXPECT_NEAR(velocity_of(simulation, 0).x(), 0, 1e-12);
    }
  }
}

/// Returns the velocity of the first of two balls of 1 kg after an off-centre collision.
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
  EXPECT_LT(exact.z(), 0.95);  // relative to 1 m/s: the effect of friction is not small
  for (const StepControl control : {StepControl::adaptive, StepControl::local}) {
    // Variable steps have a tolerance of 1 % of the effect of friction.
    EXPECT_NEAR(glance_off(control, 1e-3).z(), exact.z(), 0.01 * (1 - exact.z()))
        << to_string(control);
  }
}

TEST(Friction, GivesTheSameBitsForAnyThreadsAndFromASnapshot) {
  Scene scene = make_crowd(IntegratorId::velocity_verlet, 1e-3);
  scene.default_interface = {5000, 2, 0.5};
  expect_same_bits(scene, 20, 10);
}

}  // namespace
}  // namespace vat::friction_test
