#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/momentum_watch.h"
#include "tests/support/same_bits.h"

// Drops with both models of surface tension. LIQ-8 compares periods and pressures with theory.

namespace vat::drops_test {
namespace {

using namespace test;

constexpr Real kRadius = 0.05;   // [m]
constexpr Real kSigma = 0.5;     // [N/m]
constexpr Real kDensity = 1000;  // [kg/m^3]

/// Speed of surface waves as long as the drop [m/s].
const Real kCapillarySpeed = std::sqrt(kSigma / (kDensity * kRadius));

/// A scene whose drop has a radius of `layers` spacings. Sound is 20 times faster than surface
/// waves.
Scene make_wet_scene(SurfaceModel model, int dimensions, int layers, Real viscosity) {
  const Real sound = 20 * kCapillarySpeed;
  const Real support = (dimensions == 3 ? 2.5 : 3) * kRadius / layers;
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.25 * support / sound);
  scene.dimensions = dimensions;
  scene.pressure_solver = PressureSolver::tait;
  scene.surface_model = model;
  LiquidConstants water{sound * sound, viscosity, support};
  water.surface_tension = kSigma;
  water.artificial_viscosity = 0.05;
  scene.materials = {make_liquid("water", kDensity, water), make_material("stone", 2000)};
  return scene;
}

constexpr int kLayers = 12;
constexpr Real kSpacing = kRadius / kLayers;

Scene make_plane_scene(SurfaceModel model) {
  return make_wet_scene(model, 2, kLayers, 1);
}

BodyDescription make_drop(const char* name, Shape shape, Real spacing = kSpacing) {
  return {name, BodyKind::liquid, "water", std::move(shape), spacing};
}

/// Runs for `crossings` times in which a wave crosses the radius. Expects no guard events.
void advance_for(Simulation& simulation, Real crossings) {
  const Real steps = crossings * kRadius / kCapillarySpeed / simulation.step_size();
  EXPECT_TRUE(simulation.advance(static_cast<std::uint32_t>(std::lround(steps))).events.empty());
}

void set_angle(Scene& scene, const char* other, Real angle) {
  scene.interfaces = {{{"water", other}, {}, {}, angle}};
}

/// The half of a disc above or below z = 0.
BodyDescription make_half_drop(bool above) {
  std::vector<Vec3> points;
  for (Vec3 p : make_lattice(2 * kLayers, 1, 2 * kLayers, kSpacing)) {
    if (p.norm() < kRadius && (p.z() > 0) == above) points.push_back(p);
  }
  return make_body("drop", BodyKind::liquid, "water",
                   make_particles(points, kDensity * kSpacing * kSpacing), kSpacing / 2);
}

/// A fixed slab below or above z = 0.
BodyDescription make_slab(bool below) {
  BodyDescription slab{"slab", BodyKind::rigid, "stone",
                       BoxShape{{0, 0, below ? -0.025 : 0.025}, {0.4, kSpacing, 0.05}}, kSpacing};
  slab.fixed = true;
  return slab;
}

/// Returns the height of the centre of mass of a part of a disc that meets the floor at this angle.
/// The unit is the square root of its area.
Real cap_height(Real angle) {
  const Real area = angle - std::sin(angle) * std::cos(angle);  // for radius 1
  return (2 * std::pow(std::sin(angle), 3) / (3 * area) - std::cos(angle)) / std::sqrt(area);
}

/// Returns the angle [degrees] of the scene's drop, which rests on z = 0, from its shape.
Real rested_angle(const Scene& scene) {
  Simulation simulation = make_simulation(scene);
  advance_for(simulation, 30);
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

// With curvature, the contact line extends over a support radius, a quarter of the drop's radius.
// Half of that is 7 degrees. With cohesion it is an eighth of the radius, over which the wall's
// attraction changes: 1/8 of a radian at 60 degrees, and 9 degrees at 120.
TEST(Drops, RestAtTheContactAngleOfAWall) {
  struct Case {
    SurfaceModel model;
    std::vector<Real> angles;
    Real tolerance;
  };
  for (const auto& [model, angles, tolerance] : {Case{SurfaceModel::curvature, {75, 90, 135}, 7},
                                                 Case{SurfaceModel::cohesion, {30, 90, 135}, 9}}) {
    for (const Real angle : angles) {
      Scene scene = make_plane_scene(model);
      scene.vat = Vat{{-0.3, -1, 0}, {0.3, 1, 0.3}, false, {}};
      set_angle(scene, kVatMaterial, angle);
      scene.bodies = {make_half_drop(true)};
      EXPECT_NEAR(rested_angle(scene), angle, tolerance) << to_string(model);
    }
  }
}

TEST(Drops, RestAtTheContactAngleOfABody) {
  for (const Real angle : {45.0, 120.0}) {
    Scene scene = make_plane_scene(SurfaceModel::cohesion);
    set_angle(scene, "stone", angle);
    scene.bodies = {make_half_drop(true), make_slab(true)};
    EXPECT_NEAR(rested_angle(scene), angle, 9);
  }
}

/// Returns whether a drop below a body falls off.
bool falls(Real angle, Real gravity) {
  Scene scene = make_plane_scene(SurfaceModel::cohesion);
  scene.gravity = {0, 0, -gravity};
  set_angle(scene, "stone", angle);
  scene.bodies = {make_half_drop(false), make_slab(false)};
  Simulation simulation = make_simulation(scene);
  for (int n = 0; n < 20; ++n) {
    advance_for(simulation, 1);
    if (simulation.diagnostics().bodies[0].center_of_mass.z() < -4 * kRadius) return true;
  }
  return false;
}

// The drop weighs rho g pi R^2 / 2. At most 2 sigma hold it.
TEST(Drops, HangUnderABodyThatTheyWet) {
  const Real greatest = 4 * kSigma / (kDensity * std::numbers::pi * kRadius * kRadius);
  EXPECT_FALSE(falls(45, 0.5 * greatest));
  EXPECT_TRUE(falls(45, 3 * greatest));
  EXPECT_TRUE(falls(135, 1.5 * greatest));
}

/// A drop that translates and rotates.
BodyDescription make_turning_drop() {
  BodyDescription drop = make_drop("drop", SphereShape{Vec3::Zero(), kRadius});
  drop.velocity = {0.5 * kCapillarySpeed, 0, 0};
  drop.angular_velocity = {0, 0.3 * kCapillarySpeed / kRadius, 0};
  return drop;
}

TEST(Drops, WithCurvatureStayTogetherAndKeepTheirMomentum) {
  Scene scene = make_plane_scene(SurfaceModel::curvature);
  scene.pair_precision = PairPrecision::double_precision;
  scene.bodies = {make_turning_drop()};
  scene.bodies[0].jitter = 0.05;
  Simulation simulation = make_simulation(scene);
  const MomentumWatch watch(simulation);
  advance_for(simulation, 10);
  watch.expect_momentum();
  watch.expect_angular_momentum(1e-10);
  const Vec3 center = simulation.diagnostics().bodies[0].center_of_mass;
  const BodyView end = simulation.bodies()[0];
  for (const Vec3& p : end.positions) {
    EXPECT_LT((p - center).norm(), 1.3 * kRadius);
  }
}

TEST(Drops, WithCohesionHoldAStoneAndKeepTheMomentum) {
  for (const BodyKind kind : {BodyKind::rigid, BodyKind::deformable}) {
    Scene scene = make_plane_scene(SurfaceModel::cohesion);
    scene.pair_precision = PairPrecision::double_precision;
    set_angle(scene, "stone", 50);
    scene.materials[1].springs =
        LatticeSprings{SpringConstants{2000, 1}, SpringConstants{1000, 1}, {}};
    scene.bodies = {make_turning_drop(),
                    {"stone", kind, "stone",
                     BoxShape{{0, 0, 1.4 * kRadius}, Vec3::Constant(0.6 * kRadius)}, kSpacing}};
    Simulation simulation = make_simulation(scene);
    const MomentumWatch watch(simulation);
    const Vec3 before = totals_of(simulation.diagnostics()).momentum;
    advance_for(simulation, 10);
    watch.expect_momentum();
    watch.expect_angular_momentum(1e-10);
    const Diagnostics now = simulation.diagnostics();
    const Vec3 apart = now.bodies[0].center_of_mass - now.bodies[1].center_of_mass;
    EXPECT_LT(apart.norm(), 1.4 * kRadius);
    EXPECT_GT(now.bodies[1].linear_momentum.norm(), 0.1 * before.norm());
  }
}

TEST(Drops, ThatTouchBecomeOne) {
  constexpr int kCoarse = 8;
  Scene scene = make_wet_scene(SurfaceModel::curvature, 2, kCoarse, 0.1);
  for (const Real side : {-1.0, 1.0}) {
    scene.bodies.push_back(make_drop(side < 0 ? "left" : "right",
                                     SphereShape{{side * 1.02 * kRadius, 0, 0}, kRadius},
                                     kRadius / kCoarse));
    scene.bodies.back().jitter = 0.05;
    scene.bodies.back().velocity = {-0.3 * side * kCapillarySpeed, 0, 0};
  }
  Simulation simulation = make_simulation(scene);
  advance_for(simulation, 25);
  const Real merged = std::sqrt(2.0) * kRadius;
  for (const BodyView& drop : simulation.bodies()) {
    for (const Vec3& p : drop.positions) EXPECT_LT(p.norm(), 1.2 * merged);
  }
}

TEST(Drops, WithCohesionHoldMeltedAndPouredParticles) {
  Scene scene = make_plane_scene(SurfaceModel::cohesion);
  scene.materials.push_back(make_material("ice", kDensity));
  scene.materials.back().springs =
      LatticeSprings{SpringConstants{500, 1}, SpringConstants{250, 1}, {}};
  const Real size = 1.2 * kRadius;
  BodyDescription ice{"ice", BodyKind::deformable, "ice",
                      BoxShape{Vec3::Zero(), Vec3(size, kSpacing, size)}, kSpacing};
  ice.melting = Melting{"water", 0.05};
  scene.bodies = {ice, make_drop("drop", SphereShape{{0, 0, 4 * kRadius}, kRadius / 2})};
  scene.emitters = {{.name = "nozzle",
                     .body = "drop",
                     .position = {0, 0, 3 * kRadius},
                     .radius = kRadius / 2,
                     .speed = kCapillarySpeed,
                     .most_particles = 600}};
  Simulation simulation = make_simulation(scene);
  advance_for(simulation, 15);
  const std::vector<BodyView> bodies = simulation.bodies();
  EXPECT_GT(bodies[1].positions.size(), 200u);
  for (const BodyView& body : bodies) {
    for (const Vec3& p : body.positions) EXPECT_LT(p.norm(), 6 * kRadius);
  }
}

TEST(Drops, MayBeDrainedAltogether) {
  Scene scene = make_wet_scene(SurfaceModel::curvature, 3, 6, 0.1);
  scene.bodies = {make_drop("drop", SphereShape{Vec3::Zero(), kRadius}, kRadius / 6)};
  scene.drains = {{"sink", Vec3::Constant(-1), Vec3::Constant(1)}};
  Simulation simulation = make_simulation(scene);
  EXPECT_TRUE(simulation.advance(3).events.empty());
  EXPECT_TRUE(simulation.bodies()[0].positions.empty());
}

TEST(Drops, GiveTheSameBitsForAnyThreadsAndFromASnapshot) {
  for (const SurfaceModel model : {SurfaceModel::curvature, SurfaceModel::cohesion}) {
    const bool is_plane = model == SurfaceModel::cohesion;
    Scene scene = is_plane ? make_plane_scene(model) : make_wet_scene(model, 3, 6, 0.1);
    scene.bodies = {
        make_drop("drop", SphereShape{{0, 0, 0.055}, kRadius}, is_plane ? kSpacing : kRadius / 6)};
    if (is_plane) scene.bodies.push_back(make_slab(true));
    scene.gravity = {0, 0, -1};
    scene.vat = Vat{{-0.3, -0.1, is_plane ? -0.05 : 0}, {0.3, 0.1, 1}, false, {}};
    scene.periodic = Periodicity{{-0.3, -0.1, 0}, {0.3, 0.1, 1}, {true, !is_plane, false}};
    for (const StepControl control : {StepControl::fixed, StepControl::adaptive}) {
      scene.numerics.control = control;
      expect_same_bits(scene, 20, 10);
    }
  }
}

}  // namespace
}  // namespace vat::drops_test
