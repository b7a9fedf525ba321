#include "core/laws/friction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"
#include "tests/support/totals.h"

namespace vat::test::friction_test {
namespace {

constexpr Real kStiffness = 500;           // [N/m]
constexpr Real kRadius = 0.1;              // [m]
constexpr Real kFriction = 0.4;            // coefficient
constexpr Real kPush = kStiffness * 0.05;  // [N] overlap force of a pair or at the floor

/// Particles of 1 kg and 2 kg, 0.15 m apart along (3, 0, 4) / 5. The first moves.
Scene make_pair_scene(const Vec3& velocity, BodyKind first = BodyKind::deformable,
                      BodyKind second = BodyKind::deformable) {
  Scene scene =
      make_scene(IntegratorId::velocity_verlet, 1e-3,
                 {make_liquid("a", 1000, {0, 0, 0.1}), make_liquid("b", 1000, {0, 0, 0.1})});
  scene.default_interface = {kStiffness, 0, kFriction};
  scene.bodies = {make_body("moving", first, "a", make_particles({{0, 0, 0}}, 1), kRadius),
                  make_body("resting", second, "b", make_particles({{0.09, 0, 0.12}}, 2), kRadius)};
  scene.bodies[0].velocity = velocity;
  return scene;
}

const Vec3 kNormal(-0.6, 0, -0.8);  // from the resting particle to the moving one
const Vec3 kAcross(0.8, 0, -0.6);

/// A particle of 1 kg that overlaps the floor as much as the particles of the pair overlap.
Scene make_floor_scene(const Vec3& velocity, BodyKind kind = BodyKind::rigid) {
  Scene scene = make_pair_scene(velocity, kind);
  scene.bodies.resize(1);
  scene.bodies[0].position = {0, 0, kRadius - 0.05};
  scene.vat = Vat{{-3, -3, 0}, {3, 3, 1}, false, {}, {}};
  return scene;
}

TEST(Friction, IsTheCoefficientTimesThePushAgainstTheSlip) {
  for (const BodyKind first : kBodyKinds) {
    for (const BodyKind second : kBodyKinds) {
      const ForceProbe probe(make_pair_scene(3 * kAcross - 4 * Vec3::UnitY(), first, second));
      const Vec3 expected = kPush * (kNormal - kFriction * (0.6 * kAcross - 0.8 * Vec3::UnitY()));
      EXPECT_LT((probe.force(0) - expected).norm(), 1e-12)
          << to_string(first) << " and " << to_string(second);
      EXPECT_EQ(probe.force(0), Vec3(-probe.force(1)));
    }
  }
}

TEST(Friction, OfASlowSlipIsProportionalToIt) {
  const Real sticking = std::sqrt(kStiffness * 2 / 3);
  const Real slip = 0.9 * kFriction * kPush / sticking;
  const ForceProbe probe(make_pair_scene(slip * kAcross));
  EXPECT_LT((probe.force(0) - (kPush * kNormal - sticking * slip * kAcross)).norm(), 1e-12);
  EXPECT_EQ(probe.force(0), Vec3(-probe.force(1)));
}

TEST(Friction, IsOfThePushThatActs) {
  Scene scene = make_pair_scene(7 * kAcross + 2 * kNormal);  // receding at 2 m/s
  for (const Real damping : {0.0, 5.0, 12.0, 13.0}) {
    scene.default_interface.damping = damping;
    const Real push = std::max(0.0, kPush - 2 * damping);
    const ForceProbe probe(scene);
    EXPECT_LT((probe.force(0) - push * (kNormal - kFriction * kAcross)).norm(), 1e-12) << damping;
  }
}

TEST(Friction, IsOfTheInterfaceOfTheTwoMaterials) {
  Scene scene = make_pair_scene(7 * kAcross);
  scene.interfaces = {{{"b", "a"}, {kStiffness, 0, 0.1}, {}},
                      {{"a", "vat"}, {kStiffness, 0, 3}, {}}};
  EXPECT_NEAR(ForceProbe(scene).force(0).dot(kAcross), -0.1 * kPush, 1e-12);
  scene.interfaces[0].constants.friction = 0;
  EXPECT_NEAR(ForceProbe(scene).force(0).dot(kAcross), 0, 1e-14);
}

TEST(Friction, IsNotWithinABody) {
  Scene scene = make_pair_scene(Vec3::Zero());
  ParticleShape two = make_particles({{0, 0, 0}, {0.3, 0, 0}}, 1);
  two.velocities = {{0, 3, 0}, {0, 0, 0}};
  scene.materials[0].self_contact = SpringConstants{kStiffness, 0};
  scene.bodies = {make_body("body", BodyKind::deformable, "a", two, kRadius)};
  ForceProbe probe(scene);
  probe.state().now.position[1].x() =
      0.15;  // not excluded, since the particles are apart at the start
  probe.evaluate();
  EXPECT_NEAR(probe.force(0).x(), -kPush, 1e-12);
  EXPECT_EQ(probe.force(0).y(), 0);
}

TEST(Friction, OfParticlesInOnePlaceIsOpposite) {
  Scene scene = make_pair_scene({10, 20, 30});
  std::get<ParticleShape>(scene.bodies[1].shape).positions[0].setZero();
  const ForceProbe probe(scene);
  EXPECT_EQ(probe.force(0), Vec3(-probe.force(1)));
  EXPECT_NEAR(probe.force(0).norm(), kStiffness * 2 * kRadius * std::hypot(1, kFriction), 1e-10);
}

TEST(Friction, ActsAtWalls) {
  for (const BodyKind kind : kBodyKinds) {
    const ForceProbe probe(make_floor_scene({3, -4, 0}, kind));
    const Vec3 expected = kPush * Vec3(-0.6 * kFriction, 0.8 * kFriction, 1);
    EXPECT_LT((probe.force(0) - expected).norm(), 1e-12) << to_string(kind);
  }
  const Real sticking = std::sqrt(kStiffness);
  EXPECT_NEAR(ForceProbe(make_floor_scene({0.1, 0, 0})).force(0).x(), -0.1 * sticking, 1e-12);
}

TEST(Friction, SeesTheSlipAlongWallsThatMove) {
  Scene scene = make_floor_scene({0.3, 0.2, 0});
  scene.vat->walls[4].velocity = {0.3, 0.2, 0};
  EXPECT_EQ(ForceProbe(scene).force(0), Vec3(0, 0, ForceProbe(scene).force(0).z()));
  scene.vat->motion = SlideMotion{{1, 0, 0}, 2, 2};  // pi m/s after a quarter of a period
  ForceProbe probe(scene);
  probe.evaluate(0.5);
  EXPECT_NEAR(probe.force(0).x(), kFriction * kPush, 1e-12);
  EXPECT_NEAR(probe.force(0).y(), 0, 1e-12);
}

TEST(Friction, LoadsParticlesWithItsGreatestRate) {
  const auto rate = [](const Scene& scene) {
    return ForceProbe(scene).work().of<ContactForceScratch>().contact_loads[0].damping;
  };
  EXPECT_NEAR(rate(make_pair_scene(kAcross)), 2 * std::sqrt(kStiffness * 2 / 3), 1e-12);
  Scene scene = make_floor_scene({1, 0, 0});
  EXPECT_NEAR(rate(scene), std::sqrt(kStiffness), 1e-12);
  scene.default_interface.damping = 30;  // exceeds the friction force, but acts across it
  EXPECT_EQ(rate(scene), 30);
  scene.default_interface = {kStiffness, 2, 0};
  EXPECT_EQ(rate(scene), 2);
}

TEST(Friction, IsKeptForTheSolveAsADragAcrossTheContact) {
  Scene scene = make_pair_scene(7 * kAcross);
  scene.default_interface.damping = 2;
  ForceProbe probe(scene);
  Workspace work;
  work.keep_dampers = true;
  const Controls controls;
  ForceModel{probe.model(), controls, work}.evaluate(probe.state().now, 0, probe.state().forces);
  const DamperBlock& block = work.of<ContactForceScratch>().contact_dampers[0];
  ASSERT_EQ(block.rows[0].particle, 0U);
  ASSERT_EQ(block.rows[0].damper_end, 1U);
  EXPECT_EQ(block.dampers[0].other, 1U);
  EXPECT_EQ(block.dampers[0].strength, 2);
  ASSERT_EQ(block.rows[0].friction_end, 1U);
  EXPECT_EQ(block.friction_dampers[0].other, 1U);
  EXPECT_NEAR(block.friction_dampers[0].strength, kFriction * kPush / 7, 1e-12);
  EXPECT_LT((block.friction_dampers[0].normal - kNormal).norm(), 1e-12);
}

TEST(Friction, ActsAtTheContact) {
  const Vec3 way(0, 0, 0.3);
  const auto expect = [&](bool is_rigid, bool is_other_rigid, Real self, Real other) {
    const ContactArms arms = contact_arms(way, is_rigid, 0.2, is_other_rigid, 0.4);
    EXPECT_LT((arms.self - self * way).norm(), 1e-15);
    EXPECT_LT((arms.other - other * way).norm(), 1e-15);
  };
  expect(true, true, -1.0 / 3, 2.0 / 3);
  expect(true, false, -1, 0);
  expect(false, true, 0, 1);
  expect(false, false, 0, 0);
}

TEST(Friction, TurnsRigidBodiesAndIsTurnedByThem) {
  Scene scene = make_pair_scene(Vec3::Zero(), BodyKind::rigid, BodyKind::rigid);
  scene.bodies[0].angular_velocity = {0, 40, 0};
  ForceProbe probe(scene);
  // The contact point, at half of 0.15 m, moves at 3 m/s along omega x arm.
  const Vec3 slip = Vec3(0, 40, 0).cross(Vec3(-0.075 * kNormal));
  EXPECT_LT((probe.force(0) - kPush * (kNormal - kFriction * slip / 3)).norm(), 1e-12);
  const Vec3 torque = -0.075 * kNormal.cross(-kFriction * kPush * slip / 3);
  for (const Vec3& each : probe.state().forces.rigid_torque) {
    EXPECT_LT((each - torque).norm(),
              1e-12);  // equal torques: their sum balances the couple of the forces
  }
}

/// Returns the slip of a particle that starts to stick to the floor after 100 steps with omega dt =
/// 1.95, relative to the initial slip.
Real slip_left(Real damping) {
  Scene scene = make_floor_scene({1e-3, 0, 0}, BodyKind::deformable);
  const Real omega = std::sqrt(kStiffness);
  scene.numerics.step = scene.numerics.tick = 1.95 / omega;
  scene.default_interface.damping = damping * omega;
  scene.gravity = {0, 0, -kPush};
  Simulation simulation = make_advanced(scene, 100);
  return velocity_of(simulation, 0).x() / 1e-3;
}

// Explicit forces would be unstable at rate dt > 1. The solver then includes friction.
TEST(Friction, IsStableIfItMustBeSolvedFor) {
  for (const Real damping : {0.0, 1.0, 100.0}) {
    EXPECT_LT(std::abs(slip_left(damping)), 1e-6) << damping;
  }
}

}  // namespace
}  // namespace vat::test::friction_test
