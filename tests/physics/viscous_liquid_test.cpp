#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/momentum_watch.h"
#include "tests/support/same_bits.h"
#include "tests/support/scenes.h"

// Solids and walls in a liquid whose viscosity the steps do not resolve. LIQ-7 and LIQ-19 compare
// with theory.

namespace vat::viscous_liquid_test {
namespace {

using namespace test;

constexpr Real kStep = 1e-3;
constexpr Real kSpacing = 0.1;
constexpr Real kSupport = 0.3;
constexpr Real kViscosity = 2e4;

/// A cube of honey, seven particles wide, with a stone three particles wide in its middle.
Scene make_honey(PressureSolver solver, bool fixed) {
  const bool is_tait = solver == PressureSolver::tait;
  Scene scene =
      make_scene(is_tait ? IntegratorId::velocity_verlet : IntegratorId::symplectic_euler, kStep);
  scene.pressure_solver = solver;
  scene.materials = {make_liquid("honey", 1000, {1, kViscosity, kSupport}), make_material("stone")};
  std::vector<Vec3> honey;
  std::vector<Vec3> stone;
  for (const Vec3& x : make_lattice(7, 7, 7, kSpacing)) {
    (x.lpNorm<Eigen::Infinity>() < 1.5 * kSpacing ? stone : honey).push_back(x);
  }
  scene.bodies = {
      make_body("honey", BodyKind::liquid, "honey", make_particles(honey, 1), kSpacing / 2),
      make_body("stone", BodyKind::rigid, "stone", make_particles(stone, 2), kSpacing / 2)};
  scene.bodies[0].angular_velocity = {0.1, 0.2, 0.3};
  scene.bodies[0].velocity = {0, 0, 0.1};
  scene.bodies[1].fixed = fixed;
  return scene;
}

/// The rate is 2 / 0.028 nu / h^2. Steps of at most 2 / rate are stable with explicit viscosity.
TEST(ThickLiquids, StepsOfTheseTestsDoNotResolveIt) {
  EXPECT_GT(kStep * 2 / 0.028 * (kViscosity / 1000) / (kSupport * kSupport), 10);
}

class ThickLiquid : public testing::TestWithParam<PressureSolver> {};

/// Runs a scene in which only the liquid moves. Expects that its energy never increases. Returns
/// the remaining fraction.
Real energy_left(const Scene& scene, int steps) {
  Simulation simulation = make_simulation(scene);
  const Real start = simulation.diagnostics().kinetic_energy;
  Real energy = start;
  for (int n = 0; n < steps; ++n) {
    advance_to(simulation, simulation.time() + kStep);
    const Real now = simulation.diagnostics().kinetic_energy;
    EXPECT_LT(now, energy * (1 + 1e-9)) << n;
    energy = now;
  }
  return energy / start;
}

TEST_P(ThickLiquid, AFixedStoneOnlyTakesItsEnergy) {
  EXPECT_LT(energy_left(make_honey(GetParam(), true), 100), 1e-2);
}

/// Adds a closed box of no-slip walls around the honey.
Scene make_sticky_box(Scene scene) {
  scene.bodies.resize(1);
  scene.bodies[0].velocity.setZero();
  scene.vat = Vat{Vec3::Constant(-0.35), Vec3::Constant(0.35), true, {}, {}};
  for (Wall& wall : scene.vat->walls) wall.no_slip = true;
  return scene;
}

// In a box of width L, velocities decay at a rate of at least 3 pi^2 nu / L^2.
TEST(ThickLiquids, NoSlipWallsOnlyTakeEnergy) {
  Scene scene = make_sticky_box(make_honey(PressureSolver::tait, true));
  scene.materials[0].liquid->viscosity = 50;
  const Real rate = 3 * std::pow(std::numbers::pi / 0.7, 2) * 50 / 1000;
  EXPECT_LT(energy_left(scene, 200), std::exp(-2 * rate * 200 * kStep));
}

TEST_P(ThickLiquid, GivesTheSameBitsForAnyThreadsAndFromASnapshot) {
  Scene scene = make_sticky_box(make_honey(GetParam(), true));
  scene.vat->walls[5].velocity = {0.1, 0, 0};
  expect_same_bits(scene, 20, 10);
}

TEST_P(ThickLiquid, AFreeStoneMovesWithItAndMomentumIsKept) {
  Scene scene = make_honey(GetParam(), false);
  scene.pair_precision = PairPrecision::double_precision;
  Simulation simulation = make_simulation(scene);
  const MomentumWatch watch(simulation);
  advance_to(simulation, 100 * kStep);
  watch.expect_momentum();
  watch.expect_angular_momentum(1e-10);
  const std::vector<BodyDiagnostics> bodies = simulation.diagnostics().bodies;
  const Vec3 of_honey = bodies[0].linear_momentum / bodies[0].mass;
  const Vec3 of_stone = bodies[1].linear_momentum / bodies[1].mass;
  EXPECT_LT((of_stone - of_honey).norm(), 0.01 * of_honey.norm());
}

// Slip walls carry the load, so no particle has to be moved back inside.
TEST_P(ThickLiquid, SinksOntoASlipFloorAndStaysAboveIt) {
  Scene scene = make_honey(GetParam(), true);
  scene.gravity = {0, 0, -9.81};
  scene.bodies.resize(1);
  scene.bodies[0].angular_velocity.setZero();
  scene.vat = Vat{{-1, -1, -4 * kSpacing}, {1, 1, 1}, true, {}, {}};
  Simulation simulation = make_simulation(scene);
  for (int n = 0; n < 500; ++n) {
    const AdvanceReport report = simulation.advance(1);
    ASSERT_TRUE(report.events.empty()) << n;
    ASSERT_EQ(report.wall_stops, 0U) << n;
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, ThickLiquid,
                         testing::Values(PressureSolver::tait, PressureSolver::incompressible),
                         [](const auto& solver) { return std::string(to_string(solver.param)); });

}  // namespace
}  // namespace vat::viscous_liquid_test
