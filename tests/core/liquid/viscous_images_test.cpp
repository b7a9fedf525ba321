// Effects of walls on a viscous liquid if walls take part in it: the force between two particles
// and their images.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/liquid/pairs/viscous_images.h"
#include "core/model/acting_forces.h"
#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"

namespace vat::test::viscous_images_test {
namespace {

constexpr Real kSupport = 0.1;
constexpr Real kSpacing = 0.04;
constexpr Real kViscosity = 3;
constexpr Real kDistance = 0.02;
const Vec3 kVelocity(1, -2, 3);

/// One particle at kDistance from a wall, and another at kSpacing from the first in the direction
/// `along`.
Scene make_wall_scene(int wall, int along) {
  const int axis = wall / 2;
  Vec3 place = Vec3::Constant(0.5);
  place[axis] = wall % 2 == 0 ? kDistance : 1 - kDistance;
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-4);
  scene.pressure_solver = PressureSolver::tait;
  scene.pair_precision = PairPrecision::double_precision;
  LiquidConstants water{0, kViscosity, kSupport};
  water.artificial_viscosity = 0;
  scene.materials = {make_liquid("water", 1000, water)};
  const Real mass = 1000 * std::pow(kSpacing, 3);
  scene.bodies = {make_body("drops", BodyKind::liquid, "water",
                            make_particles({place, place + kSpacing * Vec3::Unit(along)}, mass),
                            kSpacing / 2)};
  scene.bodies[0].velocity = kVelocity;
  scene.vat = Vat{Vec3::Zero(), Vec3::Ones(), true, {}, {}};
  scene.vat->walls[static_cast<std::size_t>(wall)].no_slip = true;
  return scene;
}

/// Returns the viscous force 2 (d + 2) mu V^2 W'/r x x^T / (x^2 + 0.01 (h/2)^2) at distance r,
/// divided by x x^T [N s/m^3].
Real strength(const ForceProbe& probe, Real r) {
  const LiquidModel& liquid = *probe.model().liquids[0];
  const Real volume = std::pow(kSpacing, 3);
  return -2 * (3 + 2) * kViscosity * volume * volume * liquid.slope_scale *
         liquid.kernel.slope_over_r(r) / (r * r + 0.0025 * kSupport * kSupport);
}

/// Adds artificial viscosity of 1 * rho c h / 2 = 50 Pa s to 2 (3 + 2) mu = 30 Pa s. Images in slip
/// walls then have no viscosity.
constexpr Real kThinFactor = 80.0 / 30;
void make_thin(Scene& scene) {
  scene.materials[0].liquid->stiffness = 1;
  scene.materials[0].liquid->artificial_viscosity = 1;
}

// Normal to the wall, the image approaches the particle. Parallel to a no-slip wall, the image
// moves the opposite way. Both velocities differ from the particle's by twice its velocity. The
// force acts along x, component by component.
TEST(ViscousImages, HaveTheVelocityTurnedRound) {
  for (int n = 0; n < 24; ++n) {
    const int wall = n / 4;
    const bool no_slip = n % 2 == 0;
    const bool thin = n % 4 > 1;
    const int axis = wall / 2;
    const int along = (axis + 1) % 3;
    Scene scene = make_wall_scene(wall, along);
    scene.vat->walls[static_cast<std::size_t>(wall)].no_slip = no_slip;
    if (thin) make_thin(scene);
    const ForceProbe probe(scene);
    EXPECT_EQ(is_dragged_by_all_images(probe.model()), !thin);
    const Real across = 2 * kDistance;
    const Real factor = !thin ? 1 : no_slip ? kThinFactor : 0;
    const Real own = factor * strength(probe, across) * across * across;
    const Real others = factor * strength(probe, std::hypot(across, kSpacing));
    Vec3 expected = Vec3::Zero();
    expected[axis] = -(own + others * across * across) * 2 * kVelocity[axis];
    if (no_slip) expected[along] = -others * kSpacing * kSpacing * 2 * kVelocity[along];
    EXPECT_LE((probe.force(0, 0) - expected).norm(), 1e-12 * expected.norm()) << n;
    EXPECT_LE((probe.force(0, 1) - expected).norm(), 1e-12 * expected.norm()) << n;
  }
}

TEST(ViscousImages, MoveWithTheWallAndTheVat) {
  constexpr int kAlong = 0;
  Scene scene = make_wall_scene(4, kAlong);
  scene.bodies[0].velocity = Vec3::Zero();
  scene.vat->walls[4].velocity = {0.5, 0.25, 0};
  scene.vat->motion = SlideMotion{Vec3::UnitX(), 0.2, 4};
  ForceProbe probe(scene);
  const Real others = strength(probe, std::hypot(2 * kDistance, kSpacing)) * kSpacing * kSpacing;
  EXPECT_NEAR(probe.force(0).x(), others * 2 * 0.5, 1e-12 * others);
  EXPECT_EQ(probe.force(0).y(), 0);  // the particles lie on the x axis
  probe.evaluate(1);                 // the vat moves at 0.1 pi/2
  EXPECT_NEAR(probe.force(0).x(), others * 2 * (0.5 + 0.05 * std::numbers::pi), 1e-12 * others);
}

TEST(ViscousImages, CostNothingWithoutEffect) {
  const auto has_stage = [](const Scene& scene) {
    return has_viscous_images(ForceProbe(scene).model());
  };
  Scene scene = make_wall_scene(4, 0);
  EXPECT_TRUE(has_stage(scene));
  scene.forces.viscosity = false;
  EXPECT_FALSE(has_stage(scene));
  EXPECT_EQ(ForceProbe(scene).force(0), Vec3::Zero());
  scene.forces.viscosity = true;
  scene.materials[0].liquid->viscosity = 0;
  EXPECT_FALSE(has_stage(scene));
  scene.materials[0].liquid->viscosity = kViscosity;
  scene.vat->walls[4].no_slip = false;
  EXPECT_TRUE(has_stage(scene));
  make_thin(scene);
  EXPECT_FALSE(has_stage(scene));
  EXPECT_EQ(ForceProbe(scene).force(0), Vec3::Zero());
}

}  // namespace
}  // namespace vat::test::viscous_images_test
