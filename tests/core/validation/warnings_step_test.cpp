// Warnings of steps that are too long for the forces or the motion of a scene.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/numerics/contact_limits.h"
#include "core/validation/validate.h"
#include "tests/core/validation/warned_scenes.h"

namespace vat::test::warnings_step_test {
namespace {

TEST(Warnings, AreOfTheStepThatAnAccuracyChooses) {
  Scene scene = oscillator(1e8, 0);
  EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
  scene.numerics.accuracy = 0.1;
  EXPECT_EQ(warnings_of(scene), "");
}

TEST(Warnings, OfAStepBeyondTheSpringsLimit) {
  // The bound is omega^2 <= 2 k / m. At dt = 1 ms, Verlet is stable up to k = 2 m / dt^2 = 2e6.
  EXPECT_EQ(warnings_of(oscillator(1.99e6, 0)), "");
  EXPECT_EQ(warnings_of(oscillator(2.01e6, 0)), "unstable_step /numerics/step");
}

TEST(Warnings, OfIntegratorsThatMakeUndampedSpringsGrow) {
  Scene scene = oscillator(100, 0);
  scene.numerics.integrator = IntegratorId::heun;
  EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
  EXPECT_EQ(warnings_of(oscillator(100, 0)), "");
  scene.bodies[0].springs[0].constants.damping = 1;
  EXPECT_EQ(warnings_of(scene), "");
}

/// Selects an integrator that computes damping from the velocity half a step before.
Scene with_late_damping(Scene scene) {
  scene.numerics.integrator = IntegratorId::symplectic_euler;
  return scene;
}

TEST(Warnings, OfDampedSpringsBeyondTheStep) {
  // The limit is 2 c / m dt = 2: c = 1000 N s/m at 1 ms. Velocity Verlet has no limit.
  EXPECT_EQ(warnings_of(with_late_damping(oscillator(1, 990))), "");
  EXPECT_EQ(warnings_of(with_late_damping(oscillator(1, 1010))), "unstable_step /numerics/step");
  EXPECT_EQ(warnings_of(oscillator(1, 1010)), "");
  // Explicit Euler: dt <= c / k.
  Scene scene = oscillator(1000, 1.01);
  scene.numerics.integrator = IntegratorId::explicit_euler;
  EXPECT_EQ(warnings_of(scene), "");
  scene.bodies[0].springs[0].constants.damping = 0.99;
  EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
}

/// Two rigid particles of 1 kg. The reduced mass of their contact is 1/2 kg.
Scene two_grains(const InterfaceConstants& contact) {
  Scene scene;
  scene.pressure_solver = PressureSolver::gas;
  scene.materials.emplace_back();
  scene.materials[0].name = "wood";
  scene.bodies.resize(2);
  for (std::size_t b = 0; b < 2; ++b) {
    scene.bodies[b] = {"grain " + std::to_string(b), BodyKind::rigid, "wood",
                       ParticleShape{{{static_cast<Real>(b), 0, 0}}, {}, {1}, {0.1}, {}}, 0};
  }
  scene.default_interface = contact;
  return scene;
}

TEST(Warnings, OfStiffContacts) {
  // omega^2 = k / mu: dt = 1 ms is stable up to k = 4 mu / dt^2 = 2e6.
  EXPECT_EQ(warnings_of(two_grains({1.99e6, 0})), "");
  EXPECT_EQ(warnings_of(two_grains({2.01e6, 0})), "unstable_step /numerics/step");
  Scene scene = two_grains({1e9, 0});
  scene.interfaces = {{{"wood", "wood"}, {1000, 1}, {}}};  // overrides the default
  EXPECT_EQ(warnings_of(scene), "");
  scene.interfaces[0].constants.stiffness = 2.01e6;
  EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
  scene.bodies.pop_back();  // a single body has no contacts
  EXPECT_EQ(warnings_of(scene), "");
}

TEST(Warnings, OfDampedContacts) {
  // 2 c / mu dt <= 4: c <= 1000 N s/m.
  EXPECT_EQ(warnings_of(with_late_damping(two_grains({0, 990}))), "");
  EXPECT_EQ(warnings_of(with_late_damping(two_grains({0, 1010}))), "unstable_step /numerics/step");
}

TEST(Warnings, OfContactsThatNoStepHolds) {
  Scene scene = two_grains({1000, 0});
  for (const IntegratorId integrator : {IntegratorId::heun, IntegratorId::explicit_euler}) {
    scene.numerics.integrator = integrator;
    EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
    EXPECT_THAT(find_warnings(scene)[0].message, testing::HasSubstr("no step is short enough"));
  }
}

TEST(Warnings, OfManyContactsOfOneBody) {
  // 64 simultaneous contacts on 8 kg: omega^2 = 64 k / m, so k <= 4 m / (64 dt^2) = 5e5.
  Scene scene;
  scene.pressure_solver = PressureSolver::gas;
  scene.materials.emplace_back();
  scene.materials[0].name = "m";
  scene.vat = Vat{{-1, -1, 0}, {1, 1, 2}, false, {}};
  scene.bodies = {{"slab", BodyKind::rigid, "m", BoxShape{{0, 0, 0}, {0.4, 0.4, 0.05}}, 0.05}};
  scene.bodies[0].position = {0, 0, 0.03};
  scene.interfaces = {{{"m", "vat"}, {4.9e5, 0}, {}}};
  EXPECT_EQ(warnings_of(scene), "");
  scene.interfaces[0].constants.stiffness = 5.1e5;
  EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
  scene.bodies[0].orientation = Quat(Eigen::AngleAxis<Real>(0.3, Vec3(1, 2, 3).normalized()));
  scene.bodies[0].position.z() = 0.5;
  EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
}

TEST(Warnings, CountTheParticlesOfTheFlattestSide) {
  const auto count = [](Shape shape) {
    BodyDescription body{"b", BodyKind::rigid, "m", std::move(shape), 0.1};
    return count_flattest_side(sample_body(body, Material{}), Quat::Identity());
  };
  EXPECT_EQ(count(BoxShape{{0, 0, 0}, {0.5, 0.4, 0.3}}), 20u);
  EXPECT_EQ(count(BoxShape{{0, 0, 0}, {0.1, 0.1, 0.9}}), 9u);
  EXPECT_EQ(count(ParticleShape{{{0, 0, 0}}, {}, {1}, {1}, {}}), 1u);
  // An oblique plane, found by its principal axes.
  const Vec3 u = Vec3(1, 2, 3).normalized();
  const Vec3 v = u.cross(Vec3::UnitX()).normalized();
  ParticleShape plane;
  for (int i = 0; i < 20; ++i) plane.positions.push_back((i % 5) * u + (i / 5) * v);
  EXPECT_EQ(count(plane), 20u);
}

TEST(Warnings, OfMotionTooFastForTheStep) {
  Scene scene = two_grains({1000, 1});
  scene.bodies[0].angular_velocity = {0, 0, 490};
  EXPECT_EQ(warnings_of(scene), "");
  scene.bodies[0].angular_velocity = {0, 0, 510};
  EXPECT_EQ(warnings_of(scene), "turns_too_fast /bodies/0/angular_velocity");
  scene.bodies[0].angular_velocity.setZero();
  scene.bodies[1].velocity = {0, 199, 0};  // contact distance 0.2 m, step 1 ms
  EXPECT_EQ(warnings_of(scene), "");
  scene.bodies[1].velocity = {0, 201, 0};
  EXPECT_EQ(warnings_of(scene), "too_fast /bodies/1/velocity");
  scene.bodies.erase(scene.bodies.begin());  // a single body has no limit
  EXPECT_EQ(warnings_of(scene), "");
  scene.vat = Vat{{-9, -9, -9}, {9, 9, 9}, true, {}};
  scene.bodies[0].velocity = {0, 101, 0};  // contact distance of a wall: 0.1 m
  EXPECT_EQ(warnings_of(scene), "too_fast /bodies/0/velocity");
}

TEST(Warnings, OfSoundAndViscosityBeyondTheStep) {
  // c dt / h <= 0.96: c <= 96 m/s with h = 0.1 m and dt = 1 ms.
  Scene scene = pool({95.0 * 95, 1, 0.1});
  EXPECT_EQ(warnings_of(scene), "");
  scene.materials[0].liquid->stiffness = 97.0 * 97;
  EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
  // nu dt / h^2 <= 0.126: mu <= 1260 Pa s.
  scene.numerics.integrator = IntegratorId::symplectic_euler;
  scene.materials[0].liquid = LiquidConstants{1e-6, 1250, 0.1};
  EXPECT_EQ(warnings_of(scene), "");
  scene.materials[0].liquid->viscosity = 1270;
  EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
}

}  // namespace
}  // namespace vat::test::warnings_step_test
