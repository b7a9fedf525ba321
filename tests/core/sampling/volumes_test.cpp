#include "core/sampling/volumes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/numerics/step_limits.h"
#include "tests/core/validation/warned_scenes.h"
#include "tests/support/scenes.h"

namespace vat::test::volumes_test {
namespace {

/// A closed cubic vat of 0.4 m, filled with water.
Scene make_full_vat() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.pressure_solver = PressureSolver::tait;
  scene.materials = {make_liquid("water", 1000, {100, 1, 0.1}), make_material("cork", 250)};
  scene.vat = Vat{{0, 0, 0}, {0.4, 0.4, 0.4}, true, {}};
  scene.bodies = {BodyDescription{"water", BodyKind::liquid, "water",
                                  BoxShape{{0.2, 0.2, 0.2}, {0.4, 0.4, 0.4}}, 0.05}};
  return scene;
}

BodyDescription make_cork(const Shape& shape) {
  BodyDescription cork{"cork", BodyKind::rigid, "cork", shape, 0.05};
  cork.position = {0.2, 0.2, 0.3};
  return cork;
}

bool is_full(const Scene& scene) {
  const std::vector<SampledBody> samples = sample_bodies(scene);
  return fills_world(scene, pointers_to(samples));
}

TEST(Volumes, OfALiquidParticleAreItsMassOverTheRestDensity) {
  const Scene scene = make_full_vat();
  EXPECT_NEAR(particle_volumes(scene, 0, sample_bodies(scene)[0])[3], 0.05 * 0.05 * 0.05, 1e-15);
}

TEST(Volumes, OfASolidAddUpToItsShape) {
  Scene scene = make_full_vat();
  scene.bodies.push_back(make_cork(SphereShape{Vec3::Zero(), 0.08}));
  scene.bodies.push_back(make_cork(ParticleShape{{{0, 0, 0}}, {}, {}, {}, {}}));
  scene.bodies[2].radius = 0.01;
  const std::vector<SampledBody> samples = sample_bodies(scene);
  const Real count = static_cast<Real>(samples[1].positions.size());
  EXPECT_NEAR(particle_volumes(scene, 1, samples[1])[0] * count, 4 * M_PI / 3 * std::pow(0.08, 3),
              1e-15);
  EXPECT_NEAR(particle_volumes(scene, 2, samples[2])[0], std::pow(0.02, 3), 1e-18);
}

TEST(Volumes, FillAWorldThatIsClosed) {
  Scene scene = make_full_vat();
  EXPECT_TRUE(is_full(scene));
  scene.vat->lid = false;
  EXPECT_FALSE(is_full(scene));
  scene.periodic = Periodicity{{0, 0, 0}, {0.4, 0.4, 0.4}, {false, false, true}};
  EXPECT_TRUE(is_full(scene));
  scene.forces.walls = false;
  EXPECT_FALSE(is_full(scene));
  scene = make_full_vat();
  scene.vat->max.z() = 0.401;
  EXPECT_FALSE(is_full(scene));
}

TEST(Volumes, PerfectLatticesThatFillTheirWorldAreWarnedOf) {
  const auto is_warned_of = testing::HasSubstr("perfect_lattice /bodies/0/jitter");
  Scene scene = make_full_vat();
  EXPECT_THAT(warnings_of(scene), is_warned_of);
  scene.bodies[0].jitter = 0.1;
  EXPECT_THAT(warnings_of(scene), testing::Not(is_warned_of));
  scene.bodies[0].jitter = 0;
  scene.vat->lid = false;
  EXPECT_THAT(warnings_of(scene), testing::Not(is_warned_of));
}

// A solid with a quarter of the liquid's mass and the same volume has twice the frequency at the
// same forces. A rigid body may be half as heavy.
TEST(StepLimits, OfALightSolidInALiquidAreThoseOfTheLiquidByTheRatioOfDensities) {
  Scene scene = make_full_vat();
  scene.materials[0].liquid->viscosity = 0;
  scene.materials[0].liquid->artificial_viscosity = 0;
  scene.default_interface = {0, 0};
  scene.bodies.push_back(make_cork(BoxShape{Vec3::Zero(), {0.1, 0.1, 0.1}}));
  scene.materials[1].density = 125;
  const std::vector<StepLimit> limits = find_step_limits(scene, sample_bodies(scene));
  ASSERT_EQ(limits.size(), 2U);
  EXPECT_EQ(limits[0].path, "/bodies/0");
  EXPECT_EQ(limits[1].path, "/bodies/1");
  EXPECT_NEAR(limits[1].step, limits[0].step / 2, 1e-9);
  scene.bodies[1].kind = BodyKind::deformable;
  scene.materials[1].density = 250;
  EXPECT_NEAR(find_step_limits(scene, sample_bodies(scene)).at(1).step, limits[1].step, 1e-9);
  scene.materials[1].density = 1000;
  EXPECT_EQ(find_step_limits(scene, sample_bodies(scene)).size(), 1U);
}

// Solids and walls that take part in a liquid have no contacts with it.
TEST(StepLimits, OfCoupledLiquidsHaveNoContacts) {
  Scene scene = make_full_vat();
  scene.default_interface = {1e9, 0};
  EXPECT_EQ(find_step_limits(scene, sample_bodies(scene)).size(), 1U);
  scene.pressure_solver = PressureSolver::gas;
  EXPECT_EQ(find_step_limits(scene, sample_bodies(scene)).size(), 2U);
}

}  // namespace
}  // namespace vat::test::volumes_test
