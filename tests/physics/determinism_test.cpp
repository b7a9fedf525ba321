#include <gtest/gtest.h>

#include <set>

#include "tests/support/mixed_scenes.h"
#include "tests/support/same_bits.h"

namespace vat::determinism_test {
namespace {

using namespace test;

TEST(Determinism, OfAllKindsWithEveryMethod) {
  std::vector<Scene> scenes;
  for (const IntegratorId integrator : kIntegrators) {
    scenes.push_back(make_crowd(integrator, 1e-3));
  }
  for (const IntegratorId integrator : {IntegratorId::velocity_verlet, IntegratorId::heun}) {
    scenes.push_back(make_crowd(integrator, 5e-3));
    scenes.back().numerics.control = StepControl::adaptive;
    scenes.back().numerics.tolerance = 1e-2;
  }
  std::set<std::uint64_t> ends;
  for (const Scene& scene : scenes) {
    SCOPED_TRACE(to_string(scene.numerics.integrator) + std::string(", ") +
                 to_string(scene.numerics.control));
    ThreadRunner runner(3);
    Simulation simulation = make_simulation(scene, &runner);
    EXPECT_GT(simulation.diagnostics().contact_energy, 0);
    const AdvanceReport report = simulation.advance(8);
    EXPECT_TRUE(report.events.empty());
    EXPECT_EQ(report.steps > 8, scene.numerics.control == StepControl::adaptive);
    EXPECT_GT(runner.runs(), 0U);
    EXPECT_TRUE(ends.insert(simulation.state_hash()).second) << "two methods give the same bits";
    expect_same_bits(scene, 8, 4);
  }
}

TEST(Determinism, OfTwoSimulationsSideBySide) {
  const Scene first = make_crowd(IntegratorId::heun, 1e-3);
  const Scene second = make_crowd(IntegratorId::velocity_verlet, 1e-3);
  const auto end_of = [](const Scene& scene) {
    Simulation simulation = make_simulation(scene);
    simulation.advance(12);
    return simulation.state_hash();
  };
  Simulation a = make_simulation(first);
  Simulation b = make_simulation(second);
  for (int n = 0; n < 12; ++n) {
    a.advance(1);
    b.advance(1);
  }
  EXPECT_EQ(a.state_hash(), end_of(first));
  EXPECT_EQ(b.state_hash(), end_of(second));
}

}  // namespace
}  // namespace vat::determinism_test
