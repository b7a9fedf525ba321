// Limits of the totals of a scene, and of a body or an interface that is added to it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/limits.h"
#include "core/validation/validate.h"
#include "core/validation/validate_parts.h"
#include "tests/support/errors.h"

namespace vat::test::validate_limits_test {
namespace {

TEST(Validate, LimitsTheTotals) {
  Scene scene;
  scene.materials.emplace_back();
  scene.materials[0].name = "m";
  scene.materials[0].springs = LatticeSprings{{{1, 0}}, {{1, 0}}, {{1, 0}}};
  const BoxShape box{{0, 0, 0}, {1, 1, 1}};
  scene.bodies = {{"a", BodyKind::rigid, "m", box, 0.0125},
                  {"b", BodyKind::rigid, "m", box, 0.0125}};
  const auto codes = [&] { return errors_of(find_errors(scene)); };
  EXPECT_EQ(codes(), "too_many /bodies");  // 2 x 80^3 particles
  scene.bodies[0].spacing = 0.02;
  EXPECT_EQ(codes(), "");
  scene.bodies = {{"a", BodyKind::deformable, "m", box, 0.0125}};
  EXPECT_EQ(codes(), "too_many /bodies");  // 12 x 80^3 springs
}

/// A dense body: more particles within 0.15 m than may be mutual neighbours.
ParticleShape crowd() {
  constexpr Real kDistance = 0.01;
  ParticleShape shape;
  for (int i = 0; i < 15 * 15 * 15; ++i) {
    shape.positions.push_back(kDistance * Vec3(i % 15, i / 15 % 15, i / 225));
  }
  return shape;
}

Scene crowded_scene(BodyKind kind, Real radius) {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].name = "m";
  scene.materials[0].liquid = LiquidConstants{1, 1, 0.02};
  scene.bodies.resize(1);
  scene.bodies[0] = {"crowd", kind, "m", crowd(), 0};
  scene.bodies[0].mass = 1;
  scene.bodies[0].radius = radius;
  return scene;
}

TEST(Validate, LimitsTheNeighboursOfALiquid) {
  Scene scene = crowded_scene(BodyKind::liquid, 0.005);
  EXPECT_EQ(errors_of(find_errors(scene)), "");
  scene.materials[0].liquid->support_radius = 100;
  const Errors errors = find_errors(scene);  // 3375^2 neighbours
  ASSERT_EQ(errors_of(errors), "too_many /bodies");
  EXPECT_THAT(errors[0].message, testing::HasSubstr("support radius of \"m\""));
}

TEST(Validate, LimitsTheNeighboursWithinABody) {
  Scene scene = crowded_scene(BodyKind::deformable, 100);
  EXPECT_EQ(errors_of(find_errors(scene)), "");  // the particles do not collide
  scene.materials[0].self_contact = SpringConstants{1, 0};
  EXPECT_EQ(errors_of(find_errors(scene)), "too_many /bodies");
  scene.bodies[0].radius = 0.005;
  EXPECT_EQ(errors_of(find_errors(scene)), "");
}

TEST(Validate, LimitsTheNeighboursOfOtherBodies) {
  Scene scene = crowded_scene(BodyKind::rigid, 0.005);
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[1].name = "another";
  scene.bodies[1].position = {0.15, 0, 0};
  EXPECT_EQ(errors_of(find_errors(scene)), "");
  scene.interfaces = {{{"m", "m"}, {1, 0}, 1.0}};
  const Errors errors = find_errors(scene);
  ASSERT_EQ(errors_of(errors), "too_many /bodies");
  EXPECT_THAT(errors[0].message, testing::HasSubstr("threshold of \"crowd\" and \"another\""));
  scene.interfaces.clear();
  scene.bodies[1].radius = 1;
  EXPECT_EQ(errors_of(find_errors(scene)), "too_many /bodies");
}

TEST(Validate, LetsALargeParticleLieInALiquid) {
  Scene scene = crowded_scene(BodyKind::liquid, 0.005);  // each of 3375 particles reaches the ball
  scene.bodies.push_back(
      {"ball", BodyKind::rigid, "m", ParticleShape{{{0, 0, 1}}, {}, {1}, {1}, {}}});
  EXPECT_EQ(errors_of(find_errors(scene)), "");
}

TEST(Validate, LimitsTheLatticesTogetherAndStopsAtTheFirstExcess) {
  Scene scene;
  scene.materials.emplace_back();
  scene.materials[0].name = "m";
  // A large box with few particles: 1.7 m along a diagonal, 170^3 lattice points.
  const CylinderShape rod{{0, 0, 0}, {1, 1, 1}, 0.01, 1.7 * std::sqrt(3.0)};
  for (int i = 0; i < 100; ++i) {
    scene.bodies.push_back({"rod " + std::to_string(i), BodyKind::rigid, "m", rod, 0.01});
  }
  EXPECT_EQ(errors_of(find_errors(scene)), "too_many /bodies/1/spacing");
  scene.bodies.resize(1);
  EXPECT_EQ(errors_of(find_errors(scene)), "");
}

TEST(Validate, LimitsTheTrianglesOfAllMeshes) {
  MeshShape mesh;
  mesh.triangles.resize(kMaxMeshTriangles);
  Allowance allowance;
  for (std::size_t taken = kMaxMeshTriangles; taken <= kMaxSceneTriangles;
       taken += kMaxMeshTriangles) {
    EXPECT_EQ(allowance.take_mesh(mesh), nullptr);
  }
  EXPECT_FALSE(allowance.is_exceeded());
  EXPECT_NE(allowance.take_mesh(mesh), nullptr);
  EXPECT_TRUE(allowance.is_exceeded());
}

TEST(Validate, ChecksAnInterfaceAlone) {
  const Scene scene = crowded_scene(BodyKind::rigid, 0.005);
  Scene two = scene;
  two.bodies.push_back(scene.bodies[0]);
  const std::vector<Vec3>& points = std::get<ParticleShape>(scene.bodies[0].shape).positions;
  const std::vector<Real> radii(points.size(), 0.005);
  CurrentScene present;
  present.bodies.assign(2, {points, radii, 0});
  InterfaceDescription interface { {"m", "m"}, {1, 0}, 0.01 };
  const auto codes = [&] {
    return errors_of(find_interface_errors(two, present, interface, "/interface"));
  };
  EXPECT_EQ(codes(), "");
  interface.constants.damping = -1;
  EXPECT_EQ(codes(), "out_of_range /interface/damping");
  interface.constants.damping = 0;
  interface.materials[1] = "x";
  EXPECT_EQ(codes(), "unknown_name /interface/materials/1");
  interface.materials[1] = "m";
  interface.threshold = 1;
  EXPECT_EQ(codes(), "too_many /interface");
}

}  // namespace
}  // namespace vat::test::validate_limits_test
