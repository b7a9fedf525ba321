#include <gtest/gtest.h>

#include "tests/support/momentum_watch.h"
#include "tests/support/same_bits.h"
#include "tests/support/scenes.h"

namespace vat::implicit_springs_test {
namespace {

constexpr Real kSpacing = 0.05;

/// A block as stiff as steel falls into a pool, next to a soft block with explicit springs. Its
/// springs would need steps of 7 microseconds.
Scene make_pool(PressureSolver solver, StepControl control) {
  Scene scene = test::make_scene(IntegratorId::velocity_verlet, 5e-4);
  scene.numerics.tick = 0.01;
  scene.numerics.control = control;
  scene.gravity = {0, 0, -9.81};
  scene.pressure_solver = solver;
  scene.materials = {test::make_liquid("water", 1000, {50, 1, 2 * kSpacing}),
                     test::make_material("steel"), test::make_material("rubber", 500)};
  scene.materials[1].springs = LatticeSprings{{{1e9, 1e3}}, {{1e9, 1e3}}, {}};
  scene.materials[1].implicit_springs = true;
  scene.materials[2].springs = LatticeSprings{{{1e3, 1}}, {{1e3, 1}}, {}};
  scene.default_interface = {1000, 2, 0.3};
  scene.vat = Vat{{0, 0, 0}, {1, 0.5, 1}, false, {}, {}};
  const auto add = [&](const char* name, BodyKind kind, const char* material, const BoxShape& box) {
    BodyDescription body{name, kind, material, box, kSpacing};
    scene.bodies.push_back(std::move(body));
  };
  add("pool", BodyKind::liquid, "water", {{0.5, 0.25, 0.15}, {0.95, 0.45, 0.2}});
  add("block", BodyKind::deformable, "steel", {{0.3, 0.25, 0.4}, {0.2, 0.2, 0.15}});
  add("soft", BodyKind::deformable, "rubber", {{0.7, 0.25, 0.4}, {0.2, 0.2, 0.15}});
  return scene;
}

class ImplicitSpringsInScenes : public testing::TestWithParam<PressureSolver> {};

TEST_P(ImplicitSpringsInScenes, MeetLiquidBodiesAndWalls) {
  for (const StepControl control : {StepControl::fixed, StepControl::adaptive}) {
    Simulation simulation = test::make_simulation(make_pool(GetParam(), control));
    const Vec3 first = test::position_of(simulation, 1, 0);
    const Vec3 last = test::position_of(simulation, 1, 47);
    const AdvanceReport report = simulation.advance(400);
    EXPECT_TRUE(report.events.empty()) << to_string(control);
    EXPECT_EQ(report.unsolved_drifts, 0U) << to_string(control);
    EXPECT_GT(report.least_step, 3e-5) << to_string(control);
    EXPECT_LT(test::position_of(simulation, 1, 0).z(), first.z() - 0.05);
    const Real length =
        (test::position_of(simulation, 1, 47) - test::position_of(simulation, 1, 0)).norm();
    EXPECT_NEAR(length / (last - first).norm(), 1, 1e-4) << to_string(control);
  }
}

TEST_P(ImplicitSpringsInScenes, ExchangeMomentumWithNothingLost) {
  Scene scene = make_pool(GetParam(), StepControl::fixed);
  scene.pair_precision = PairPrecision::double_precision;
  scene.vat.reset();
  scene.gravity.setZero();
  for (BodyDescription& body : scene.bodies) body.position.z() = body.name == "pool" ? 0 : -0.05;
  scene.bodies[1].velocity = {0, 0.2, -0.5};
  Simulation simulation = test::make_simulation(scene);
  const test::MomentumWatch watch(simulation);
  const Vec3 block = simulation.diagnostics().bodies[1].linear_momentum;
  simulation.advance(400);
  watch.expect_momentum();
  EXPECT_GT((simulation.diagnostics().bodies[1].linear_momentum - block).norm(),
            0.1 * block.norm());
}

TEST_P(ImplicitSpringsInScenes, HaveTheSameBitsForAnyThreads) {
  test::expect_same_bits(make_pool(GetParam(), StepControl::adaptive), 40, 20);
}

INSTANTIATE_TEST_SUITE_P(Solvers, ImplicitSpringsInScenes,
                         testing::Values(PressureSolver::gas, PressureSolver::tait),
                         [](const auto& solver) { return std::string(to_string(solver.param)); });

}  // namespace
}  // namespace vat::implicit_springs_test
