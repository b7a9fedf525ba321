#include <gtest/gtest.h>

#include <cstdint>

#include "core/simulation/simulation.h"
#include "tests/support/scenes.h"

namespace vat::test::volume_solve_test {
namespace {

TEST(VolumeSolve, CountsTheIterationsOfAllSteps) {
  Scene scene = make_scene(IntegratorId::symplectic_euler, 5e-3);
  scene.gravity = {0, 0, -9.81};
  scene.pressure_solver = PressureSolver::incompressible;
  scene.materials = {make_liquid("water", 1000, {350, 10, 0.1})};
  BodyDescription pool;
  pool.name = "pool";
  pool.kind = BodyKind::liquid;
  pool.material = "water";
  pool.spacing = 0.05;
  pool.shape = BoxShape{{0.2, 0.2, 0.3}, {0.4, 0.4, 0.4}};
  scene.bodies = {pool};
  scene.vat = Vat{Vec3::Zero(), {0.4, 0.4, 1}, true, {}, {}};
  scene.incompressible.density_tolerance = 1e-4;
  Simulation by_step = make_simulation(scene);
  IterationCounts expected;
  for (int step = 0; step < 40; ++step) {
    EXPECT_EQ(by_step.advance(1).steps, 1U);
    const VolumeReport last = by_step.diagnostics().volume.value();
    expected.velocities += static_cast<std::uint64_t>(last.velocities.iterations);
    expected.places += static_cast<std::uint64_t>(last.places.iterations);
  }
  const AdvanceReport report = make_simulation(scene).advance(40);
  EXPECT_GT(expected.places, 0U);
  EXPECT_GT(expected.velocities, expected.places);
  EXPECT_EQ(report.iterations.velocities, expected.velocities);
  EXPECT_EQ(report.iterations.places, expected.places);
}

}  // namespace
}  // namespace vat::test::volume_solve_test
