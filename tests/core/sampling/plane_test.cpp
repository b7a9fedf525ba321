#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/sampling/mass_properties.h"
#include "tests/support/errors.h"
#include "tests/support/force_probe.h"
#include "tests/support/name_of.h"
#include "tests/support/scenes.h"

/// Two-dimensional scenes: densities, discs, and motion in the plane. Periodic scenes reject bodies
/// that are too large for the period.
namespace vat::test::plane_test {
namespace {

BodyDescription sampled(const char* name, BodyKind kind, const char* material, Shape shape,
                        const Vec3& position) {
  BodyDescription body{name, kind, material, std::move(shape), 0.05};
  body.position = position;
  return body;
}

/// A sliding vat with one body of each kind. All bodies move and are about to touch.
Scene plane_scene(IntegratorId integrator) {
  Scene scene = make_scene(integrator, 5e-4);
  scene.dimensions = 2;
  scene.gravity = {0.5, 0, -9.81};
  scene.materials = {make_liquid("water", 1000, {50, 5, 0.1}), make_material("gum", 500),
                     make_material("wood", 600)};
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

TEST(PlaneModel, LiquidHasTheDensityOfAnEndlessLattice) {
  for (const Real support : {1.5, 2.0, 3.0, 4.0}) {
    Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
    scene.dimensions = 2;
    scene.materials = {make_liquid("water", 1000, {1, 1, support})};
    scene.bodies = {make_body("water", BodyKind::liquid, "water",
                              make_particles(make_lattice(8, 1, 8, 1), 1000), 0.5)};
    scene.periodic = Periodicity{Vec3::Constant(-4), Vec3::Constant(4), {true, false, true}};
    const ForceProbe probe(scene);
    Real expected = 0;
    for (int x = -4; x <= 4; ++x) {
      for (int z = -4; z <= 4; ++z) {
        const Real rest = support * support - x * x - z * z;
        if (rest > 0) expected += 4 / std::numbers::pi * std::pow(rest, 3) / std::pow(support, 8);
      }
    }
    for (const Real density : probe.work().of<LiquidScratch>().density) {
      EXPECT_NEAR(density, 1000 * expected, 1e-10);
    }
  }
}

TEST(PlaneModel, RigidBodiesAreOfDiscs) {
  SampledBody sample;
  sample.positions = {{-1, 0, 0}, {3, 0, 0}};
  sample.masses = {3, 1};
  sample.radii = {0.5, 0.2};
  const MassProperties p = plane_mass_properties(sample);
  EXPECT_EQ(p.mass, 4);
  EXPECT_EQ(p.center_of_mass, Vec3::Zero());
  EXPECT_NEAR(p.inertia(1, 1), 3 * 1 + 1 * 9 + 0.5 * (3 * 0.25 + 1 * 0.04), 1e-14);
  EXPECT_EQ(p.inertia, Mat3(p.inertia(1, 1) * Mat3::Identity()));
}

TEST(PlaneModel, DiscHasTheAngularMomentumOfOne) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.dimensions = 2;
  scene.materials = {make_material("solid")};
  scene.bodies = {make_body("disc", BodyKind::rigid, "solid", make_particles({{0, 0, 0}}, 2), 0.5)};
  scene.bodies[0].angular_velocity = {0, 3, 0};
  const Simulation simulation = make_simulation(scene);
  EXPECT_NEAR(simulation.diagnostics().bodies[0].angular_momentum.y(), 0.5 * 2 * 0.25 * 3, 1e-14);
}

class Plane : public testing::TestWithParam<IntegratorId> {};

TEST_P(Plane, IsNeverLeft) {
  Scene scene = plane_scene(GetParam());
  if (GetParam() == IntegratorId::explicit_euler) scene.numerics.step = scene.numerics.tick = 1e-4;
  scene.bodies.push_back(make_body("twins", BodyKind::liquid, "water",
                                   make_particles({Vec3::Zero(), Vec3::Zero()}, 1), 0.025));
  scene.bodies.back().position = {0.2, 0, 0.8};  // two coincident particles
  EXPECT_EQ(ForceProbe(scene).model().walls, (std::vector<int>{0, 1, 4, 5}));
  Simulation simulation = make_simulation(scene);
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

INSTANTIATE_TEST_SUITE_P(Integrators, Plane, testing::ValuesIn(kIntegrators), NameOf());

TEST(PlaneCommands, ThatWouldLeaveItAreRefused) {
  Simulation simulation = make_simulation(plane_scene(IntegratorId::velocity_verlet));
  const std::uint64_t before = simulation.state_hash();
  EXPECT_EQ(errors_of(simulation.set_gravity({0, 1, 0})), "off_plane /gravity");
  EXPECT_EQ(errors_of(simulation.apply_force(simulation.bodies()[0].id, {0, 1, 0}, 1)),
            "off_plane /force");
  BodyDescription body =
      sampled("new", BodyKind::rigid, "wood", SphereShape{{0, 0, 0}, 0.1}, {0.5, 0.1, 0.8});
  EXPECT_EQ(errors_of(simulation.add_body(body)), "off_plane /body/position");
  EXPECT_EQ(simulation.state_hash(), before);
  body.position.y() = 0;
  EXPECT_EQ(errors_of(simulation.add_body(body)), "");
  EXPECT_EQ(errors_of(simulation.set_gravity({1, 0, 0})), "");
}

/// A period of 0.5 m along x, and a ball of radius 0.1 m with particles of 0.025 m.
Scene narrow_scene() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3,
                           {make_material("wood"), make_liquid("oil", 900, {10, 1, 0.3})});
  scene.periodic = Periodicity{{0, 0, 0}, {0.5, 0, 0}, {true, false, false}};
  scene.bodies = {
      sampled("ball", BodyKind::rigid, "wood", SphereShape{{0, 0, 0}, 0.1}, {0.5, 0, 0})};
  return scene;
}

TEST(PeriodCommands, ThatReachTooFarAreRefused) {
  Simulation simulation = make_simulation(narrow_scene());
  const BodyDescription small =
      sampled("small", BodyKind::rigid, "wood", SphereShape{{0, 0, 0}, 0.1}, {0.5, 0, 1});
  ASSERT_EQ(errors_of(simulation.add_body(small)), "");
  BodyDescription large = small;
  large.name = "large";
  large.position.z() = 2;
  large.radius = 0.2;
  large.spacing = 0.1;
  EXPECT_EQ(errors_of(simulation.add_body(large)), "");  // 0.2 + 0.025 m are below 0.25 m
  large.name = "larger";
  large.radius = 0.23;
  EXPECT_EQ(errors_of(simulation.add_body(large)), "out_of_range /body");
  BodyDescription oil =
      sampled("oil", BodyKind::liquid, "oil", SphereShape{{0, 0, 0}, 0.1}, {0.5, 0, 3});
  EXPECT_EQ(errors_of(simulation.add_body(oil)), "out_of_range /body");
  EXPECT_EQ(errors_of(simulation.set_interface({{"wood", "wood"}, {100, 1}, 0.26})),
            "out_of_range /interface");
  EXPECT_EQ(errors_of(simulation.set_interface({{"wood", "wood"}, {100, 1}, 0.24})), "");
}

}  // namespace
}  // namespace vat::test::plane_test
