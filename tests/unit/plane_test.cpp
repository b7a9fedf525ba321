#include <gtest/gtest.h>

#include "tests/support/scenes.h"

/// Scenes of two dimensions stay in their plane, and periodic ones keep periods that are long
/// enough, whatever users do.
namespace vat::plane_test {
namespace {

BodyDescription sampled(const char* name, BodyKind kind, const char* material, Shape shape,
                        const Vec3& position) {
  BodyDescription body;
  body.name = name;
  body.kind = kind;
  body.material = material;
  body.shape = std::move(shape);
  body.spacing = 0.05;
  body.position = position;
  return body;
}

/// One body of each kind, all moving and about to touch, in a vat that slides.
Scene plane_scene(IntegratorId integrator) {
  Scene scene = test::make_scene(integrator, 5e-4);
  scene.dimensions = 2;
  scene.gravity = {0.5, 0, -9.81};
  scene.materials = {test::make_liquid("water", 1000, {50, 5, 0.1}),
                     test::make_material("gum", 500), test::make_material("wood", 600)};
  scene.materials[1].springs = LatticeSprings{{{2000, 2}}, {{1000, 2}}, {}};
  scene.default_interface = {1000, 2};
  scene.vat = Vat{{0, -1, 0}, {1, 1, 1}, true, SlideMotion{{1, 0, 0}, 0.02, 1}, {}};
  scene.vat->walls[4] = {true, {0.2, 0, 0}};
  scene.bodies = {
      sampled("pool", BodyKind::liquid, "water", BoxShape{{0, 0, 0}, {0.8, 1, 0.2}},
              {0.5, 0, 0.15}),
      sampled("pad", BodyKind::deformable, "gum", BoxShape{{0, 0, 0}, {0.2, 1, 0.2}},
              {0.3, 0, 0.4}),
      sampled("disc", BodyKind::rigid, "wood", SphereShape{{0, 0, 0}, 0.1}, {0.7, 0, 0.4})};
  scene.bodies[0].jitter = 0.1;
  scene.bodies[0].velocity_field.emplace().waves = {{{0.1, 0, 0}, {0, 0, 6}, 0}};
  scene.bodies[1].orientation = Quat(Eigen::AngleAxis<Real>(0.3, Vec3::UnitY()));
  scene.bodies[2].angular_velocity = {0, 3, 0};
  return scene;
}

class Plane : public testing::TestWithParam<IntegratorId> {};

TEST_P(Plane, IsNeverLeft) {
  Scene scene = plane_scene(GetParam());
  if (GetParam() == IntegratorId::explicit_euler) scene.numerics.step = scene.numerics.tick = 1e-4;
  Simulation simulation = test::make_simulation(scene);
  ASSERT_TRUE(simulation.grab_start(1, simulation.bodies()[1].id, 0, {0.5, 0.3, 0.5}));
  ASSERT_TRUE(simulation.apply_force(simulation.bodies()[2].id, {1, 0, 1}, 0.1));
  simulation.advance(400);
  for (const BodyView& body : simulation.bodies()) {
    for (std::size_t i = 0; i < body.positions.size(); ++i) {
      ASSERT_EQ(body.positions[i].y(), 0) << body.name;
      ASSERT_EQ(body.velocities[i].y(), 0) << body.name;
    }
    if (!body.pose) continue;
    EXPECT_EQ(body.pose->orientation.x(), 0);
    EXPECT_EQ(body.pose->orientation.z(), 0);
    EXPECT_EQ(body.pose->angular_velocity.x(), 0);
    EXPECT_EQ(body.pose->angular_velocity.z(), 0);
    EXPECT_NE(body.pose->angular_velocity.y(), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, Plane, testing::ValuesIn(test::kIntegrators),
                         [](const auto& integrator) { return to_string(integrator.param); });

template <class T>
std::string first_error(const Result<T>& result) {
  return result.ok() ? "" : result.errors()[0].code + ' ' + result.errors()[0].path;
}

TEST(PlaneCommands, ThatWouldLeaveItAreRefused) {
  Simulation simulation = test::make_simulation(plane_scene(IntegratorId::velocity_verlet));
  const std::uint64_t before = simulation.state_hash();
  EXPECT_EQ(first_error(simulation.set_gravity({0, 1, 0})), "off_plane /gravity");
  EXPECT_EQ(first_error(simulation.apply_force(simulation.bodies()[0].id, {0, 1, 0}, 1)),
            "off_plane /force");
  BodyDescription body =
      sampled("new", BodyKind::rigid, "wood", SphereShape{{0, 0, 0}, 0.1}, {0.5, 0.1, 0.8});
  EXPECT_EQ(first_error(simulation.add_body(body)), "off_plane /body/position");
  EXPECT_EQ(simulation.state_hash(), before);
  body.position.y() = 0;
  EXPECT_EQ(first_error(simulation.add_body(body)), "");
  EXPECT_EQ(first_error(simulation.set_gravity({1, 0, 0})), "");
}

/// A period of 0.5 m along x, and a ball of radius 0.1 m in particles of 0.025 m.
Scene narrow_scene() {
  Scene scene = test::make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.materials = {test::make_material("wood"), test::make_liquid("oil", 900, {10, 1, 0.3})};
  scene.periodic = Periodicity{{0, 0, 0}, {0.5, 0, 0}, {true, false, false}};
  scene.bodies = {
      sampled("ball", BodyKind::rigid, "wood", SphereShape{{0, 0, 0}, 0.1}, {0.5, 0, 0})};
  return scene;
}

TEST(PeriodCommands, ThatReachTooFarAreRefused) {
  Simulation simulation = test::make_simulation(narrow_scene());
  const BodyDescription small =
      sampled("small", BodyKind::rigid, "wood", SphereShape{{0, 0, 0}, 0.1}, {0.5, 0, 1});
  ASSERT_EQ(first_error(simulation.add_body(small)), "");
  BodyDescription large = small;
  large.name = "large";
  large.position.z() = 2;
  large.radius = 0.2;
  large.spacing = 0.1;
  EXPECT_EQ(first_error(simulation.add_body(large)), "");  // 0.2 + 0.025 m are below 0.25 m
  large.name = "larger";
  large.radius = 0.23;
  EXPECT_EQ(first_error(simulation.add_body(large)), "out_of_range /body");
  BodyDescription oil =
      sampled("oil", BodyKind::liquid, "oil", SphereShape{{0, 0, 0}, 0.1}, {0.5, 0, 3});
  EXPECT_EQ(first_error(simulation.add_body(oil)), "out_of_range /body");
  EXPECT_EQ(first_error(simulation.set_interface({{"wood", "wood"}, {100, 1}, 0.26})),
            "out_of_range /interface");
  EXPECT_EQ(first_error(simulation.set_interface({{"wood", "wood"}, {100, 1}, 0.24})), "");
}

}  // namespace
}  // namespace vat::plane_test
