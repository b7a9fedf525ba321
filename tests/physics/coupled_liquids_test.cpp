#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/mixed_scenes.h"
#include "tests/support/momentum_watch.h"
#include "tests/support/same_bits.h"

// Liquids in which walls and solids take part: weakly compressible and incompressible.

namespace vat::coupled_liquids_test {
namespace {

using namespace test;

constexpr Real kGravity = 9.81;

/// A scene with adaptive steps within a tick of `tick` seconds.
Scene make_liquid_scene(Real tick, Real spacing) {
  Scene scene = make_scene(IntegratorId::symplectic_euler, tick);
  scene.numerics.control = StepControl::adaptive;
  scene.pressure_solver = PressureSolver::incompressible;
  scene.gravity = {0, 0, -kGravity};
  scene.materials = {make_liquid("water", 1000, {0, 0, 2 * spacing})};
  return scene;
}

/// A two-dimensional column, `height` and `width` in spacings. The vat is wider by `gap` spacings
/// on each side, and lower by `gap` spacings.
Scene make_column(int width, int height, Real spacing, Real gap = 0) {
  Scene scene = make_liquid_scene(0.01, spacing);
  scene.dimensions = 2;
  scene.vat = Vat{{-gap * spacing, -1, -gap * spacing},
                  {(width + gap) * spacing, 1, 2 * height * spacing},
                  false,
                  {}};
  scene.bodies = {BodyDescription{"water", BodyKind::liquid, "water",
                                  BoxShape{{width * spacing / 2, 0, height * spacing / 2},
                                           {width * spacing, 1, height * spacing}},
                                  spacing}};
  return scene;
}

/// Maxima over the ticks of a run.
struct Watched {
  Real mean_density_error = 0;  ///< mean over the ticks
  Real top = 0;                 ///< height of the highest particle [m]
  Real speed = 0;
  std::uint64_t undone_steps = 0;
};

Watched watch(Simulation& simulation, int ticks) {
  Watched watched;
  for (int n = 0; n < ticks; ++n) {
    const AdvanceReport report = simulation.advance(1);
    watched.undone_steps += report.undone_steps;
    watched.mean_density_error += simulation.diagnostics().mean_density_error / ticks;
    const BodyView water = simulation.bodies()[0];
    for (std::size_t i = 0; i < water.positions.size(); ++i) {
      watched.top = std::max(watched.top, water.positions[i].z());
      watched.speed = std::max(watched.speed, water.velocities[i].norm());
    }
  }
  return watched;
}

// The liquid is up to a third of a spacing too close to the walls. It expands without gaining
// speed.
TEST(Incompressible, StartsOverDenseWithoutAnExplosion) {
  constexpr Real kSpacing = 0.025;
  for (const Real gap : {-0.15, -0.3}) {
    Scene scene = make_column(12, 20, kSpacing, gap);
    Simulation simulation = make_simulation(scene);
    const Watched watched = watch(simulation, 100);
    const Real height = 20.0 * 12 / (12 + 2 * gap) * kSpacing;  // height with the same volume
    EXPECT_LT(watched.top, height + kSpacing) << gap;
    EXPECT_LT(watched.speed, 0.35 * std::sqrt(kGravity * height)) << gap;
    EXPECT_LT(simulation.diagnostics().mean_density_error, 1e-3) << gap;
    EXPECT_EQ(watched.undone_steps, 0U) << gap;
  }
}

class CoupledLiquids : public testing::TestWithParam<PressureSolver> {
 protected:
  /// The mixture with oil at its rest density.
  static Scene make_mixture() {
    const bool is_tait = GetParam() == PressureSolver::tait;
    Scene scene = make_wet_mixture(
        is_tait ? IntegratorId::velocity_verlet : IntegratorId::symplectic_euler, GetParam());
    std::ranges::fill(std::get<ParticleShape>(scene.bodies[1].shape).masses, 0.7 * 0.125);
    return scene;
  }
};

// Forces and shifts of a pair are opposite, so momentum is conserved to round-off. Shifts of
// incompressible liquids also conserve angular momentum, like the density.
TEST_P(CoupledLiquids, KeepTheMomentumOfLiquidsAndSolids) {
  Simulation simulation = make_simulation(make_mixture());
  const MomentumWatch watch(simulation);
  std::vector<Real> greatest(4, 0);
  int iterations = 0;
  for (int n = 0; n < 80; ++n) {
    simulation.advance(5);
    const Diagnostics now = simulation.diagnostics();
    for (std::size_t b = 0; b < 4; ++b) {
      greatest[b] = std::max(greatest[b], now.bodies[b].outer_force.norm());
    }
    if (now.volume) iterations += now.volume->velocities.iterations;
  }
  watch.expect_momentum();
  watch.expect_angular_momentum(GetParam() == PressureSolver::tait ? 1e-10 : 1e-3);
  EXPECT_THAT(greatest, testing::Each(testing::Gt(1))) << "of outer forces [N]";
  EXPECT_EQ(iterations > 20, GetParam() == PressureSolver::incompressible);
}

TEST_P(CoupledLiquids, GiveTheSameBitsForAnyThreadsAndFromASnapshot) {
  Scene scene = make_mixture();
  scene.gravity = {0, 0, -kGravity};
  scene.vat =
      Vat{Vec3(-0.15, -0.15, -0.15), Vec3(0.5, 0.4, 1), false, SlideMotion{{1, 0, 0}, 0.2, 2}};
  for (const StepControl control : {StepControl::fixed, StepControl::adaptive}) {
    scene.numerics.control = control;
    expect_same_bits(scene, 20, 10);
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, CoupledLiquids,
                         testing::Values(PressureSolver::tait, PressureSolver::incompressible),
                         [](const auto& solver) { return std::string(to_string(solver.param)); });

// The images of a single particle exert no force on it. It rebounds from an edge as from a face, at
// any phase of its steps.
TEST(WeaklyCompressible, ParticleLeavesEdgesAndCornersAsFastAsItCame) {
  constexpr Real kSpacing = 0.1;
  constexpr Real kSound = 10;
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.7 * 2 * kSpacing / kSound);
  scene.pressure_solver = PressureSolver::tait;
  scene.pair_precision = PairPrecision::double_precision;
  scene.materials = {make_liquid("water", 1000, {kSound * kSound, 0, 2 * kSpacing})};
  scene.vat = Vat{{0, 0, 0}, {1, 1, 1}, true, {}};
  scene.bodies = {make_body("drop", BodyKind::liquid, "water",
                            make_particles({{0.5, 0.5, 0.5}}, 1000 * std::pow(kSpacing, 3)),
                            kSpacing / 2)};
  for (const Vec3& direction :
       {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, -0.9, 0.02), Vec3(1, 1, 1), Vec3(-0.9, 1, 0.95)}) {
    for (const Real speed : {0.2, 0.5, 1.0, 2.0}) {
      scene.bodies[0].velocity = speed * direction.normalized();
      Simulation simulation = make_simulation(scene);
      EXPECT_EQ(simulation.advance(500).undone_steps, 0U);
      EXPECT_NEAR(velocity_of(simulation, 0).norm(), speed, 1e-12);
    }
  }
}

TEST(Incompressible, KeepsItsPressureIfABodyIsAdded) {
  Simulation simulation = make_simulation(make_column(12, 20, 0.025));
  simulation.advance(20);
  const BodyId water = simulation.bodies()[0].id;
  const std::vector<Real> before = simulation.liquid_fields(water).value().pressure;
  ASSERT_GT(std::ranges::max(before), 1000);
  BodyDescription drop =
      make_body("drop", BodyKind::liquid, "water", make_particles({{0.1, 0, 0.9}}, 0.625), 0.0125);
  ASSERT_TRUE(simulation.add_body(drop));
  EXPECT_EQ(simulation.liquid_fields(water).value().pressure, before);
}

/// A ball of `density` above or in a pool of water that is three diameters wide.
Scene make_ball_in_pool(Real density, Real height) {
  constexpr Real kSpacing = 0.05;
  Scene scene = make_liquid_scene(0.01, kSpacing);
  scene.materials.push_back(make_material("ball", density));
  scene.default_interface = {1e5, 100};
  scene.vat = Vat{{0, 0, 0}, {0.6, 0.6, 1.5}, false, {}};
  const SphereShape ball{Vec3(0.3, 0.3, height), 0.125};
  std::vector<Vec3> points;
  for (const Vec3& point : make_lattice(12, 12, 10, kSpacing)) {
    const Vec3 p = point + Vec3(0.3, 0.3, 0.25);
    if ((p - ball.center).norm() > ball.radius + kSpacing / 4) points.push_back(p);
  }
  scene.bodies = {
      make_body("water", BodyKind::liquid, "water", make_particles(points, 0.125), kSpacing / 2),
      BodyDescription{"ball", BodyKind::rigid, "ball", ball, kSpacing}};
  return scene;
}

// Pressure and body motion are solved together, so bodies of any density are stable.
TEST(Incompressible, IsStableWithBodiesOfAnyDensity) {
  for (const Real density : {10.0, 3000.0}) {
    const Scene scene = make_ball_in_pool(density, 0.3);
    Simulation simulation = make_simulation(scene);
    const Watched watched = watch(simulation, 60);
    EXPECT_EQ(watched.undone_steps, 0U) << density;
    EXPECT_LT(watched.speed, 8) << density;
    const Real z = simulation.bodies()[1].pose->center_of_mass.z();
    if (density < 1000) {
      EXPECT_GT(z, 0.45);
    } else {
      EXPECT_LT(z, 0.2);
    }
  }
}

/// Records whether damping was solved implicitly.
class SolveWatch final : public StageObserver {
 public:
  void stage_begins(std::string_view stage) override {
    has_solved = has_solved || stage == "solve_damping";
  }
  void stages_end() override {}
  bool has_solved = false;
};

// An implicit solve costs about a step. With increasing viscosity, steps become shorter down to
// half. Beyond that, damping is solved implicitly.
TEST(Incompressible, SolvesForViscosityIfStepsWouldBeLessThanHalf) {
  Real thin = 0;
  Real shortest_unsolved = 1;
  Real shortest_solved = 1;
  for (Real viscosity = 1; viscosity < 1e4; viscosity *= 1.25) {
    Scene scene = make_column(12, 20, 0.025);
    scene.numerics.control = StepControl::adaptive;
    scene.numerics.step = scene.numerics.tick;
    scene.materials[0].liquid->viscosity = viscosity;
    Simulation simulation = make_simulation(scene);
    SolveWatch watch;
    simulation.set_observer(&watch);
    const Real step = simulation.advance(1).greatest_step;
    if (thin == 0) thin = step;
    Real& shortest = watch.has_solved ? shortest_solved : shortest_unsolved;
    shortest = std::min(shortest, step / thin);
  }
  EXPECT_GT(shortest_unsolved, 0.45);
  EXPECT_LT(shortest_unsolved, 0.7);
  EXPECT_GT(shortest_solved, 0.9);
}

// A drop thrown into a moving vat, in two and three dimensions.
TEST(Incompressible, DropThrownIntoAMovingVatStaysInIt) {
  for (const int dimensions : {2, 3}) {
    constexpr Real kSpacing = 0.05;
    Scene scene = make_liquid_scene(0.01, kSpacing);
    scene.pair_precision = PairPrecision::double_precision;
    scene.dimensions = dimensions;
    scene.vat = Vat{{-0.5, -0.5, 0}, {0.5, 0.5, 1}, true, SlideMotion{{1, 0, 0}, 0.4, 0.8}};
    BodyDescription drop{"drop", BodyKind::liquid, "water", SphereShape{Vec3(0, 0, 0.5), 0.2},
                         kSpacing};
    drop.velocity = {5, 0, -8};
    scene.bodies = {drop};
    Simulation simulation = make_simulation(scene);
    for (int tick = 0; tick < 200; ++tick) {
      EXPECT_EQ(simulation.advance(1).undone_steps, 0U);
      const Diagnostics now = simulation.diagnostics();
      EXPECT_EQ(now.particles_outside, 0U);
      // The corrected positions are final: nothing moves the liquid afterwards.
      ASSERT_NEAR(now.max_density_error, now.volume->places.greatest, 1e-9);
      ASSERT_LE(now.mean_density_error, scene.incompressible.density_tolerance + 1e-9);
      ASSERT_LE(now.max_density_error, 36 * scene.incompressible.density_tolerance + 1e-9);
    }
  }
}

// Liquid in a nozzle keeps the nozzle's velocity at any pressure.
TEST(Incompressible, FlowsFromANozzleAndOutThroughADrain) {
  constexpr Real kSpacing = 0.025;
  constexpr Real kSpeed = 1;
  Scene scene = make_column(20, 8, kSpacing);
  scene.bodies[0].velocity = {0, 0, 0};
  scene.emitters = {{.name = "tap",
                     .body = "water",
                     .position = {0.1, 0, 0.1},  // below the surface
                     .direction = {1, 0, 0},
                     .radius = 2 * kSpacing,
                     .speed = kSpeed,
                     .most_particles = 2000}};
  scene.drains = {{"overflow", {0.45, -1, 0.2}, {0.5, 1, 0.4}}};
  Simulation simulation = make_simulation(scene);
  const std::size_t start = simulation.bodies()[0].positions.size();
  const Watched watched = watch(simulation, 100);
  const Diagnostics now = simulation.diagnostics();
  EXPECT_NEAR(static_cast<Real>(now.emitted_particles), 4 * kSpeed / kSpacing, 4 * 6);
  EXPECT_GT(now.drained_particles, 50U);
  const BodyView water = simulation.bodies()[0];
  EXPECT_EQ(water.positions.size(), start + now.emitted_particles - now.drained_particles);
  EXPECT_LT(watched.mean_density_error, 1e-3);
  EXPECT_LT(watched.speed, 3 * kSpeed);
  EXPECT_EQ(watched.undone_steps, 0U);
  const auto is_in_nozzle = [&](std::size_t i) {
    return std::abs(water.positions[i].z() - 0.1) < 2 * kSpacing &&
           water.positions[i].x() < 0.1 - kSpacing / 2 && water.velocities[i].x() == kSpeed;
  };
  std::size_t in_nozzle = 0;
  for (std::size_t i = 0; i < water.positions.size(); ++i) in_nozzle += is_in_nozzle(i) ? 1 : 0;
  EXPECT_GE(in_nozzle, 4U);
}

// The report contains the iterations and residuals of the solves.
TEST(Incompressible, ReportsIterationsAndErrorsOfItsSolves) {
  Scene scene = make_column(12, 20, 0.025);
  scene.incompressible.divergence_tolerance = 1e-6;
  Simulation simulation = make_simulation(scene);
  simulation.advance(1);
  const VolumeReport loose = *simulation.diagnostics().volume;
  EXPECT_GT(loose.velocities.iterations, 0);
  EXPECT_LE(loose.velocities.mean, 1e-6);
  EXPECT_LE(loose.velocities.mean, loose.velocities.greatest);
  EXPECT_LE(loose.places.mean, scene.incompressible.density_tolerance);
  scene.incompressible.most_iterations = 3;
  Simulation short_solves = make_simulation(scene);
  short_solves.advance(1);
  EXPECT_LE(short_solves.diagnostics().volume->velocities.iterations, 3);
  EXPECT_GT(short_solves.diagnostics().volume->velocities.mean, 1e-6);
  scene.pressure_solver = PressureSolver::tait;
  EXPECT_FALSE(make_simulation(scene).diagnostics().volume);
}

// A sideways displacement of one particle makes its neighbours too dense, but changes the mean
// little. Their excess decreases by iterations over their neighbourhood.
void expect_correction_of_few(Real density_tolerance, Real displacement) {
  Scene scene = make_column(40, 60, 0.025);
  scene.incompressible.density_tolerance = density_tolerance;
  scene.numerics.control = StepControl::fixed;
  scene.numerics.step = 1e-3;
  scene.gravity = Vec3::Zero();
  Simulation simulation = make_simulation(scene);
  const BodyView water = simulation.bodies()[0];
  ParticleShape shape = make_particles({water.positions.begin(), water.positions.end()}, 0.625);
  shape.positions[1220].x() += displacement;
  scene.bodies[0].shape = shape;
  Simulation pushed = make_simulation(scene);
  const Real limit = 36 * scene.incompressible.density_tolerance;
  EXPECT_GT(pushed.diagnostics().max_density_error, limit);
  EXPECT_LT(pushed.diagnostics().mean_density_error, scene.incompressible.density_tolerance);
  pushed.advance(1);
  const VolumeReport report = *pushed.diagnostics().volume;
  EXPECT_GT(report.places.iterations, 0);
  // Reducing the mean excess as well would take twice as many.
  EXPECT_LE(report.places.iterations, 20);
  EXPECT_LE(report.places.greatest, limit);
  EXPECT_LE(report.places.mean, scene.incompressible.density_tolerance);
}

TEST(Incompressible, CorrectsFewDenseParticlesInFewIterations) {
  expect_correction_of_few(IncompressibleSolve{}.density_tolerance, 0.012);
  // The permitted excess exceeds the excess that one round removes.
  expect_correction_of_few(3e-3, 0.022);
}

}  // namespace
}  // namespace vat::coupled_liquids_test
