#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/drops.h"
#include "tests/support/same_bits.h"
#include "tests/support/totals.h"

// What drops do whose particles attract each other.

namespace vat::cohesion_test {
namespace {

using namespace test;

constexpr int kLayers = 12;
constexpr Real kSpacing = kRadius / kLayers;

/// In the plane; sound is 20 times as fast as that.
Scene make_wet_scene(Real viscosity = 1) {
  const Real sound = 20 * capillary_speed();
  const Real support = 3 * kSpacing;
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.25 * support / sound);
  scene.dimensions = 2;
  scene.gravity.setZero();
  scene.pressure_solver = PressureSolver::tait;
  scene.surface_model = SurfaceModel::cohesion;
  LiquidConstants water{sound * sound, viscosity, support};
  water.surface_tension = kSigma;
  water.artificial_viscosity = 0.05;
  scene.materials = {make_liquid("water", kDensity, water), make_material("stone", 2000)};
  return scene;
}

void set_angle(Scene& scene, const char* other, Real angle) {
  InterfaceDescription interface;
  interface.materials = {"water", other};
  interface.contact_angle = angle;
  scene.interfaces = {interface};
}

/// The half of a disc above z = 0, or below it.
BodyDescription make_half_drop(bool above) {
  std::vector<Vec3> points;
  for (Vec3 p : make_lattice(2 * kLayers, 1, 2 * kLayers, kSpacing)) {
    if (p.norm() < kRadius && (p.z() > 0) == above) points.push_back(p);
  }
  return make_body("drop", BodyKind::liquid, "water",
                   make_particles(points, kDensity * kSpacing * kSpacing), kSpacing / 2);
}

/// Below z = 0, or above it, and fixed.
BodyDescription make_slab(bool below) {
  BodyDescription slab{"slab", BodyKind::rigid, "stone",
                       BoxShape{{0, 0, below ? -0.025 : 0.025}, {0.4, kSpacing, 0.05}}, kSpacing};
  slab.fixed = true;
  return slab;
}

/// Height of the centre of mass over the root of the area, of a part of a disc that meets the floor
/// at this angle.
Real cap_height(Real angle) {
  const Real area = angle - std::sin(angle) * std::cos(angle);  // of radius 1
  return (2 * std::pow(std::sin(angle), 3) / (3 * area) - std::cos(angle)) / std::sqrt(area);
}

/// The angle [degrees] of the drop of a scene, which rests on z = 0, by its shape.
Real rested_angle(const Scene& scene) {
  Simulation simulation = make_simulation(scene);
  advance_for(simulation, 30 * kRadius / capillary_speed());
  const BodyDiagnostics drop = simulation.diagnostics().bodies[0];
  const auto count = static_cast<Real>(simulation.bodies()[0].positions.size());
  const Real height = drop.center_of_mass.z() / std::sqrt(count * kSpacing * kSpacing);
  Real low = 0.05;
  Real high = std::numbers::pi;
  for (int n = 0; n < 50; ++n) {
    const Real middle = (low + high) / 2;
    (cap_height(middle) < height ? low : high) = middle;
  }
  return low * 180 / std::numbers::pi;
}

// Half a support radius, over which the wall's pull changes, is an eighth of the drop's radius: 1/8
// of a radian at 60 degrees, and 9 degrees at 120.
constexpr Real kSharpness = 9;

TEST(Cohesion, RestsAtTheContactAngleOfAWall) {
  for (const Real angle : {30.0, 60.0, 90.0, 120.0, 135.0}) {
    Scene scene = make_wet_scene();
    scene.vat = Vat{{-0.3, -1, 0}, {0.3, 1, 0.3}, false, {}};
    set_angle(scene, kVatMaterial, angle);
    scene.bodies = {make_half_drop(true)};
    EXPECT_NEAR(rested_angle(scene), angle, kSharpness);
  }
}

TEST(Cohesion, RestsAtTheContactAngleOfABody) {
  for (const Real angle : {45.0, 90.0, 120.0}) {
    Scene scene = make_wet_scene();
    set_angle(scene, "stone", angle);
    scene.bodies = {make_half_drop(true), make_slab(true)};
    EXPECT_NEAR(rested_angle(scene), angle, kSharpness);
  }
}

/// Whether a drop under a body falls off it.
bool falls(Real angle, Real gravity) {
  Scene scene = make_wet_scene();
  scene.gravity = {0, 0, -gravity};
  set_angle(scene, "stone", angle);
  scene.bodies = {make_half_drop(false), make_slab(false)};
  Simulation simulation = make_simulation(scene);
  for (int n = 0; n < 20; ++n) {
    advance_for(simulation, kRadius / capillary_speed());
    if (simulation.diagnostics().bodies[0].center_of_mass.z() < -4 * kRadius) return true;
  }
  return false;
}

// The drop weighs rho g pi R^2 / 2 and hangs from 2 sigma at most.
TEST(Cohesion, HoldsADropUnderABodyThatItWets) {
  const Real greatest = 4 * kSigma / (kDensity * std::numbers::pi * kRadius * kRadius);
  EXPECT_FALSE(falls(45, 0.5 * greatest));
  EXPECT_TRUE(falls(45, 3 * greatest));
  EXPECT_TRUE(falls(135, 1.5 * greatest));
}

TEST(Cohesion, KeepsTheMomentumOfADropAndAStoneThatItHolds) {
  for (const BodyKind kind : {BodyKind::rigid, BodyKind::deformable}) {
    Scene scene = make_wet_scene();
    scene.pair_precision = PairPrecision::double_precision;
    set_angle(scene, "stone", 50);
    scene.materials[1].springs =
        LatticeSprings{SpringConstants{2000, 1}, SpringConstants{1000, 1}, {}};
    BodyDescription drop{"drop", BodyKind::liquid, "water", SphereShape{Vec3::Zero(), kRadius},
                         kSpacing};
    drop.velocity = {0.5 * capillary_speed(), 0, 0};
    drop.angular_velocity = {0, 0.3 * capillary_speed() / kRadius, 0};
    BodyDescription stone{"stone", kind, "stone",
                          BoxShape{{0, 0, 1.4 * kRadius}, Vec3::Constant(0.6 * kRadius)}, kSpacing};
    scene.bodies = {drop, stone};
    Simulation simulation = make_simulation(scene);
    const Totals before = totals_of(simulation.diagnostics());
    const Motion size = motion_of(simulation);
    advance_for(simulation, 10 * kRadius / capillary_speed());
    const Diagnostics now = simulation.diagnostics();
    const Totals after = totals_of(now);
    EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12 * size.momentum);
    EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(),
              1e-10 * size.angular_momentum);
    const Vec3 apart = now.bodies[0].center_of_mass - now.bodies[1].center_of_mass;
    EXPECT_LT(apart.norm(), 1.4 * kRadius);
    EXPECT_GT(now.bodies[1].linear_momentum.norm(), 0.1 * before.momentum.norm());
  }
}

// Nothing damps it but what steps and disorder of its particles do; it gains at the start what a
// surface at rest has less than that of a lattice.
TEST(Cohesion, GivesADropNoEnergyAsItSwings) {
  Scene scene = make_wet_scene(0);
  scene.materials[0].liquid->artificial_viscosity = 0;
  BodyDescription drop{"drop", BodyKind::liquid, "water", SphereShape{Vec3::Zero(), kRadius},
                       kSpacing};
  drop.jitter = 0.02;
  VectorField field;
  const Real rate = 0.5 * capillary_speed() / kRadius;
  field.gradient = Vec3(-rate, 0, rate).asDiagonal();
  drop.velocity_field = field;
  scene.bodies = {drop};
  Simulation simulation = make_simulation(scene);
  std::array<Real, 3> greatest{};  // of two swings each
  for (Real& each : greatest) {
    for (int n = 0; n < 50; ++n) {
      advance_for(simulation, 0.1 * kRadius / capillary_speed());
      each = std::max(each, simulation.diagnostics().kinetic_energy);
    }
  }
  EXPECT_LT(greatest[1], greatest[0]);
  EXPECT_LT(greatest[2], greatest[1]);
  EXPECT_GT(greatest[2], 0.1 * greatest[0]);
}

TEST(Cohesion, HoldsWhatMeltsAndWhatANozzleAdds) {
  Scene scene = make_wet_scene();
  scene.materials.push_back(scene.materials[1]);
  scene.materials.back().name = "ice";
  scene.materials.back().density = kDensity;
  scene.materials.back().springs =
      LatticeSprings{SpringConstants{500, 1}, SpringConstants{250, 1}, {}};
  const Real size = 1.2 * kRadius;
  BodyDescription ice{"ice", BodyKind::deformable, "ice",
                      BoxShape{Vec3::Zero(), Vec3(size, kSpacing, size)}, kSpacing};
  ice.melting = Melting{"water", 0.05};
  BodyDescription drop{"drop", BodyKind::liquid, "water",
                       SphereShape{{0, 0, 4 * kRadius}, kRadius / 2}, kSpacing};
  scene.bodies = {ice, drop};
  Emitter nozzle;
  nozzle.name = "nozzle";
  nozzle.body = "drop";
  nozzle.position = {0, 0, 3 * kRadius};
  nozzle.radius = kRadius / 2;
  nozzle.speed = capillary_speed();
  nozzle.most_particles = 600;
  scene.emitters = {nozzle};
  Simulation simulation = make_simulation(scene);
  advance_for(simulation, 15 * kRadius / capillary_speed());
  const std::vector<BodyView> bodies = simulation.bodies();
  EXPECT_GT(bodies[1].positions.size(), 200u);
  for (const BodyView& body : bodies) {
    for (const Vec3& p : body.positions) EXPECT_LT(p.norm(), 6 * kRadius);
  }
}

TEST(Cohesion, GivesTheSameBitsForAnyThreadsAndFromASnapshot) {
  Scene scene = make_wet_scene();
  BodyDescription drop{"drop", BodyKind::liquid, "water", SphereShape{{0, 0, 0.055}, kRadius},
                       kSpacing};
  scene.bodies = {drop, make_slab(true)};
  scene.gravity = {0, 0, -1};
  scene.vat = Vat{Vec3(-0.3, -0.1, -0.05), Vec3(0.3, 0.1, 1), false, {}};
  scene.periodic = Periodicity{{-0.3, -0.1, 0}, {0.3, 0.1, 1}, {true, false, false}};
  expect_same_bits(scene, 20, 10);
  scene.numerics.control = StepControl::adaptive;
  expect_same_bits(scene, 20, 10);
}

}  // namespace
}  // namespace vat::cohesion_test
