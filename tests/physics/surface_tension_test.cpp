#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/drops.h"
#include "tests/support/same_bits.h"
#include "tests/support/totals.h"

// What surface tension does to drops.

namespace vat::surface_tension_test {
namespace {

using namespace test;

/// Sound is 20 times as fast as that, and the radius `layers` spacings.
Scene make_wet_scene(int dimensions, int layers) {
  const Real sound = 20 * capillary_speed();
  const Real support = (dimensions == 3 ? 2.5 : 3) * kRadius / layers;
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.3 * support / sound);
  scene.dimensions = dimensions;
  scene.pressure_solver = PressureSolver::tait;
  LiquidConstants water{sound * sound, 0.1, support};
  water.surface_tension = kSigma;
  water.artificial_viscosity = 0.05;
  scene.materials = {make_liquid("water", kDensity, water)};
  return scene;
}

BodyDescription make_drop(const char* name, Shape shape, int layers) {
  BodyDescription body{name, BodyKind::liquid, "water", std::move(shape), kRadius / layers};
  body.jitter = 0.05;
  body.seed = 7;
  return body;
}

/// The greatest distance from the centre of mass over the least that a surface particle has, seen
/// in the plane y = 0: 1 for a circle, sqrt 2 for a square.
Real roundness(const Simulation& simulation) {
  constexpr std::size_t kSectors = 16;
  const BodyDiagnostics drop = simulation.diagnostics().bodies[0];
  std::array<Real, kSectors> reach{};
  for (const Vec3& p : simulation.bodies()[0].positions) {
    const Vec3 x = p - drop.center_of_mass;
    const Real turn = std::atan2(x.z(), x.x()) / (2 * std::numbers::pi) + 0.5;
    const auto sector = std::min(kSectors - 1, static_cast<std::size_t>(turn * kSectors));
    reach[sector] = std::max(reach[sector], x.norm());
  }
  return *std::ranges::max_element(reach) / *std::ranges::min_element(reach);
}

TEST(SurfaceTension, MakesASquareRound) {
  constexpr int kLayers = 12;
  Scene scene = make_wet_scene(2, kLayers);
  scene.bodies = {
      make_drop("drop", BoxShape{Vec3::Zero(), Vec3::Constant(1.8 * kRadius)}, kLayers)};
  Simulation simulation = make_simulation(scene);
  EXPECT_GT(roundness(simulation), 1.3);
  advance_for(simulation, 3 * kRadius / capillary_speed() * 5);
  EXPECT_LT(roundness(simulation), 1 + 1.5 / kLayers);  // to a spacing, and half of another
}

TEST(SurfaceTension, KeepsADropTogetherAndItsMomentum) {
  constexpr int kLayers = 10;
  Scene scene = make_wet_scene(2, kLayers);
  scene.pair_precision = PairPrecision::double_precision;
  scene.bodies = {make_drop("drop", SphereShape{Vec3::Zero(), kRadius}, kLayers)};
  const Real speed = capillary_speed();
  scene.bodies[0].velocity = {speed, 0, 0};
  scene.bodies[0].angular_velocity = {0, 0.3 * speed / kRadius, 0};
  Simulation simulation = make_simulation(scene);
  const Totals before = totals_of(simulation.diagnostics());
  const Motion size = motion_of(simulation);
  const Real time = 10 * kRadius / speed;
  advance_for(simulation, time);
  const Diagnostics now = simulation.diagnostics();
  const Totals after = totals_of(now);
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12 * size.momentum);
  EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(),
            1e-11 * size.angular_momentum);
  for (const Vec3& p : simulation.bodies()[0].positions) {
    EXPECT_LT((p - now.bodies[0].center_of_mass).norm(), 1.3 * kRadius);
  }
}

TEST(SurfaceTension, DropsThatTouchBecomeOne) {
  constexpr int kLayers = 8;
  Scene scene = make_wet_scene(2, kLayers);
  for (const Real side : {-1.0, 1.0}) {
    scene.bodies.push_back(make_drop(side < 0 ? "left" : "right",
                                     SphereShape{{side * 1.02 * kRadius, 0, 0}, kRadius}, kLayers));
    scene.bodies.back().velocity = {-0.3 * side * capillary_speed(), 0, 0};
  }
  Simulation simulation = make_simulation(scene);
  advance_for(simulation, 25 * kRadius / capillary_speed());
  const Real merged = std::sqrt(2.0) * kRadius;
  for (const BodyView& drop : simulation.bodies()) {
    for (const Vec3& p : drop.positions) EXPECT_LT(p.norm(), 1.2 * merged);
  }
}

/// Height of the centre of mass over the root of the area, of a part of a disc that meets the floor
/// at this angle.
Real sessile_height(Real angle) {
  const Real area = angle - std::sin(angle) * std::cos(angle);  // of radius 1
  return (2 * std::pow(std::sin(angle), 3) / (3 * area) - std::cos(angle)) / std::sqrt(area);
}

/// The angle [degrees] of a drop that rests on a floor after it began as half a disc.
Real rested_angle(Real contact_angle) {
  constexpr int kLayers = 12;
  Scene scene = make_wet_scene(2, kLayers);
  scene.materials[0].liquid->viscosity = 1;
  scene.vat = Vat{{-0.2, -1, 0}, {0.2, 1, 0.2}, false, {}};
  InterfaceDescription interface;
  interface.materials = {"water", kVatMaterial};
  interface.contact_angle = contact_angle;
  scene.interfaces = {interface};
  const Real spacing = kRadius / kLayers;
  std::vector<Vec3> points;
  for (Vec3 p : make_lattice(2 * kLayers, 1, 2 * kLayers, spacing)) {
    if (p.norm() < kRadius && p.z() > 0) points.push_back(p);
  }
  const Real area = static_cast<Real>(points.size()) * spacing * spacing;
  scene.bodies = {make_body("drop", BodyKind::liquid, "water",
                            make_particles(points, kDensity * spacing * spacing), spacing / 2)};
  Simulation simulation = make_simulation(scene);
  advance_for(simulation, 30 * kRadius / capillary_speed());
  const Real height = simulation.diagnostics().bodies[0].center_of_mass.z() / std::sqrt(area);
  Real low = 0.1;
  Real high = std::numbers::pi;
  for (int n = 0; n < 50; ++n) {
    const Real middle = (low + high) / 2;
    (sessile_height(middle) < height ? low : high) = middle;
  }
  return low * 180 / std::numbers::pi;
}

// The line of contact is spread over a support radius, a quarter of the drop's radius, and half of
// that is 7 degrees of it.
TEST(SurfaceTension, RestsAtTheContactAngle) {
  for (const Real angle : {75.0, 90.0, 110.0, 135.0}) {
    EXPECT_NEAR(rested_angle(angle), angle, 7) << angle;
  }
}

TEST(SurfaceTension, OfALiquidThatIsDrainedIsNoMore) {
  Scene scene = make_wet_scene(3, 6);
  scene.bodies = {make_drop("drop", SphereShape{Vec3::Zero(), kRadius}, 6)};
  Drain drain;
  drain.name = "sink";
  drain.min = Vec3::Constant(-1);
  drain.max = Vec3::Constant(1);
  scene.drains = {drain};
  Simulation simulation = make_simulation(scene);
  EXPECT_TRUE(simulation.advance(3).events.empty());
  EXPECT_TRUE(simulation.bodies()[0].positions.empty());
}

TEST(SurfaceTension, GivesTheSameBitsForAnyThreadsAndFromASnapshot) {
  Scene scene = make_wet_scene(3, 6);
  scene.bodies = {make_drop("drop", SphereShape{{0, 0, 0.055}, kRadius}, 6)};
  scene.gravity = {0, 0, -1};
  scene.vat = Vat{Vec3(-0.1, -0.1, 0), Vec3(0.1, 0.1, 1), false, {}};
  scene.periodic = Periodicity{{-0.1, -0.1, 0}, {0.1, 0.1, 1}, {true, true, false}};
  expect_same_bits(scene, 20, 10);
  scene.numerics.control = StepControl::adaptive;
  expect_same_bits(scene, 20, 10);
}

}  // namespace
}  // namespace vat::surface_tension_test
