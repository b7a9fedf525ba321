#include <gtest/gtest.h>

#include "core/laws/pair_direction.h"
#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"

namespace vat::test::contact_test {
namespace {

constexpr Real kStiffness = 500;  // [N/m]
constexpr Real kDamping = 3;      // [N s/m]
constexpr Real kRadius = 0.1;     // [m]

/// Two single particles on the x axis. `distance` [m] separates them, and `closing` [m/s] is their
/// approach speed.
Scene make_pair_scene(Real distance, Real closing, BodyKind first = BodyKind::deformable,
                      BodyKind second = BodyKind::deformable) {
  Scene scene =
      make_scene(IntegratorId::velocity_verlet, 1e-3,
                 {make_liquid("a", 1000, {0, 0, 0.1}), make_liquid("b", 1000, {0, 0, 0.1})});
  scene.default_interface = {kStiffness, kDamping};
  scene.bodies = {make_body("left", first, "a", make_particles({{0, 0, 0}}, 1), kRadius),
                  make_body("right", second, "b", make_particles({{distance, 0, 0}}, 2), kRadius)};
  scene.bodies[0].velocity = closing * Vec3::UnitX();
  return scene;
}

Real push_on_right(const Scene& scene) {
  const ForceProbe probe(scene);
  const Vec3 force = probe.force(1);
  EXPECT_EQ(force, Vec3(-probe.force(0)));
  EXPECT_EQ(force.y(), 0);
  EXPECT_EQ(force.z(), 0);
  return force.x();
}

TEST(Contact, IsADampedSpringOfTheOverlapThatNeverPulls) {
  struct Case {
    Real distance, closing, push;
  };
  for (const auto& [distance, closing, push] :
       {Case{0.15, 0, kStiffness * 0.05}, Case{0.15, 2, kStiffness * 0.05 + kDamping * 2},
        Case{0.15, -2, kStiffness * 0.05 - kDamping * 2}, Case{0.15, -1000, 0},
        Case{2 * kRadius, 0, 0}, Case{2 * kRadius + 1e-9, 1, 0}}) {
    EXPECT_NEAR(push_on_right(make_pair_scene(distance, closing)), push, 1e-12) << distance;
  }
  EXPECT_GT(push_on_right(make_pair_scene(2 * kRadius - 1e-9, 0)), 0);
  Scene scene = make_pair_scene(0.15, 0);
  scene.bodies[0].velocity = {0, 5, -7};  // tangential motion has no effect
  EXPECT_NEAR(push_on_right(scene), kStiffness * 0.05, 1e-12);
}

TEST(Contact, StartsBelowAGivenThreshold) {
  for (const Real threshold : {0.12, 0.3}) {
    Scene scene = make_pair_scene(threshold, 0);
    scene.interfaces = {{{"b", "a"}, {kStiffness, 0}, threshold}};
    EXPECT_EQ(push_on_right(scene), 0);
    std::get<ParticleShape>(scene.bodies[1].shape).positions[0].x() = threshold - 0.01;
    EXPECT_NEAR(push_on_right(scene), kStiffness * 0.01, 1e-10);
  }
}

TEST(Contact, UsesTheInterfaceOfTheTwoMaterials) {
  Scene scene = make_pair_scene(0.15, 0);
  scene.interfaces = {{{"b", "a"}, {70, 0}, {}}, {{"a", "a"}, {1, 0}, {}}};
  EXPECT_NEAR(push_on_right(scene), 70 * 0.05, 1e-12);
  scene.bodies[1].material = "a";
  EXPECT_NEAR(push_on_right(scene), 1 * 0.05, 1e-12);
  scene.bodies[0].material = scene.bodies[1].material = "b";
  EXPECT_NEAR(push_on_right(scene), kStiffness * 0.05, 1e-12);
}

TEST(Contact, IsNotBetweenBodiesOfOneLiquid) {
  Scene scene = make_pair_scene(0.15, 0, BodyKind::liquid, BodyKind::liquid);
  scene.bodies[1].material = "a";  // no pressure either: the gas has stiffness 0
  EXPECT_EQ(push_on_right(scene), 0);
}

TEST(Contact, DirectionInOnePlaceIsAUnitVectorOfThePair) {
  for (Index i = 0; i < 50; ++i) {
    for (Index j = 0; j < i; ++j) {
      EXPECT_EQ(coincident_direction(i, j), pair_direction(Vec3::Zero(), 0, i, j));
      EXPECT_EQ(coincident_direction(i, j, 2).y(), 0);
      for (const int dimensions : {2, 3}) {
        const Vec3 n = coincident_direction(i, j, dimensions);
        EXPECT_NEAR(n.norm(), 1, 1e-15);
        EXPECT_EQ(n, Vec3(-coincident_direction(j, i, dimensions)));
      }
    }
  }
  EXPECT_NE(coincident_direction(0, 1), coincident_direction(0, 2));
}

/// One body: a spring of stiffness 0 joins particles 0 and 1, particles 2 and 3 overlap at the
/// start, and particle 4 is free.
Scene make_self_scene() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3, {make_material("rubber")});
  scene.materials[0].self_contact = SpringConstants{kStiffness, 0};
  scene.bodies = {make_body(
      "body", BodyKind::deformable, "rubber",
      make_particles({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2.15, 0, 0}, {4, 0, 0}}, 1), kRadius)};
  scene.bodies[0].springs = {{0, 1, {0, 0}, {}}};
  return scene;
}

Vec3 self_force(Index moved, const Vec3& place, Index asked) {
  ForceProbe probe(make_self_scene());
  probe.state().now.position[moved] = place;
  probe.evaluate();
  return probe.force(0, asked);
}

TEST(Contact, WithinABodyJoinsParticlesThatWereApartAndHaveNoSpring) {
  EXPECT_NEAR(self_force(4, {0, 0.15, 0}, 4).y(), kStiffness * 0.05, 1e-12);
  EXPECT_NEAR(self_force(4, {0, 0.15, 0}, 0).y(), -kStiffness * 0.05, 1e-12);
  EXPECT_EQ(self_force(1, {0, 0.15, 0}, 0), Vec3::Zero());
  EXPECT_EQ(self_force(4, {4, 0, 0}, 2), Vec3::Zero());
  EXPECT_EQ(self_force(3, {2.05, 0, 0}, 2), Vec3::Zero());
}

TEST(Contact, WithinABodyNeedsTheMaterialToHaveIt) {
  Scene scene = make_self_scene();
  scene.materials[0].self_contact.reset();
  ForceProbe probe(scene);
  probe.state().now.position[4] = {0, 0.15, 0};
  probe.evaluate();
  EXPECT_EQ(probe.force(0, 4), Vec3::Zero());
}

Scene make_wall_scene(const Vec3& position, const Vec3& velocity, bool lid = true) {
  Scene scene = make_pair_scene(0, 0);
  scene.bodies = {
      make_body("ball", BodyKind::deformable, "a", make_particles({position}, 1), kRadius)};
  scene.bodies[0].velocity = velocity;
  scene.vat = Vat{Vec3(-1, -2, -3), Vec3(1, 2, 3), lid, {}};
  return scene;
}

Vec3 wall_force(const Scene& scene) {
  return ForceProbe(scene).force(0);
}

TEST(Contact, WithEachWallPushesInwards) {
  const Vec3 size(1, 2, 3);
  for (int axis = 0; axis < 3; ++axis) {
    for (const Real side : {-1.0, 1.0}) {
      const Vec3 inside = side * (size[axis] - 0.04) * Vec3::Unit(axis);
      EXPECT_LT((wall_force(make_wall_scene(inside, Vec3::Zero())) +
                 side * kStiffness * 0.06 * Vec3::Unit(axis))
                    .norm(),
                1e-10);
      const Vec3 beyond = side * (size[axis] + 0.3) * Vec3::Unit(axis);
      EXPECT_LT((wall_force(make_wall_scene(beyond, Vec3::Zero())) +
                 side * kStiffness * 0.4 * Vec3::Unit(axis))
                    .norm(),
                1e-10);
    }
  }
  EXPECT_EQ(wall_force(make_wall_scene(Vec3::Zero(), Vec3::Zero())), Vec3::Zero());
}

TEST(Contact, WithWallsIsDampedAndWithTheLidOnlyIfThereIsOne) {
  const Vec3 near_floor(0, 0, -2.95);
  EXPECT_NEAR(wall_force(make_wall_scene(near_floor, {0, 0, -2})).z(),
              kStiffness * 0.05 + kDamping * 2, 1e-10);
  EXPECT_EQ(wall_force(make_wall_scene(near_floor, {0, 0, 1000})), Vec3::Zero());
  const Vec3 near_top(0, 0, 2.95);
  EXPECT_LT(wall_force(make_wall_scene(near_top, Vec3::Zero(), true)).z(), 0);
  EXPECT_EQ(wall_force(make_wall_scene(near_top, Vec3::Zero(), false)), Vec3::Zero());
}

TEST(Contact, WithWallsUsesTheirInterface) {
  Scene scene = make_wall_scene({0, 0, -2.7}, Vec3::Zero());
  scene.interfaces = {{{"a", kVatMaterial}, {70, 0}, 0.5}};
  EXPECT_NEAR(wall_force(scene).z(), 70 * 0.2, 1e-10);
  scene.interfaces = {{{kVatMaterial, "a"}, {70, 0}, 0.5}};
  EXPECT_NEAR(wall_force(scene).z(), 70 * 0.2, 1e-10);
}

TEST(Contact, WithAMovingWallSeesItsPlaceAndSpeed) {
  Scene scene = make_wall_scene({-0.95, 0, 0}, Vec3::Zero());
  scene.vat->motion = SlideMotion{Vec3(2, 0, 0), 0.2, 4};
  // offset = 0.1 (1 - cos(pi t / 2)), speed = 0.1 pi/2 sin(pi t / 2): at t = 1, 0.1 and 0.157.
  ForceProbe probe(scene);
  EXPECT_NEAR(probe.force(0).x(), kStiffness * 0.05, 1e-10);
  probe.evaluate(1);
  EXPECT_NEAR(probe.force(0).x(), kStiffness * 0.15 + kDamping * 0.05 * std::numbers::pi, 1e-10);
}

}  // namespace
}  // namespace vat::test::contact_test
