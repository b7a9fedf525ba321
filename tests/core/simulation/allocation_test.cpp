#include <gtest/gtest.h>

#include "core/threads/thread_pool.h"
#include "tests/support/memory/allocation_counter.h"
#include "tests/support/shaken_vat.h"

namespace vat::test::allocation_test {
namespace {

TEST(Allocation, IsCounted) {
  const std::size_t before = allocation_count();
  const std::vector<int> numbers(1000);
  EXPECT_EQ(allocation_count(), before + 1);
  EXPECT_EQ(numbers.back(), 0);
}

/// A cube of viscous liquid on the floor of a vat. Its speed of sound is 10 m/s.
Scene make_wet_vat(PressureSolver solver, int width = 5) {
  constexpr Real kSpacing = 0.1;
  const bool is_tait = solver == PressureSolver::tait;
  Scene scene =
      make_scene(is_tait ? IntegratorId::velocity_verlet : IntegratorId::symplectic_euler, 2e-3);
  scene.pressure_solver = solver;
  scene.materials = {make_liquid("honey", 1000, {100, 1000, 3 * kSpacing})};
  scene.bodies = {make_body("honey", BodyKind::liquid, "honey",
                            make_particles(make_lattice(width, width, width, kSpacing), 1),
                            kSpacing / 2)};
  scene.vat = Vat{{-1, -1, -kSpacing * width / 2}, {1, 1, 1}, true, {}, {}};
  return scene;
}

/// Runs until every buffer has its final size, then expects no allocation.
void expect_no_allocations(Simulation& simulation, std::uint32_t steps) {
  for (int n = 0; n < 2; ++n) {  // the second call copies the additions of the first call
    ASSERT_TRUE(simulation.advance(steps).events.empty());
  }
  const std::size_t before = allocation_count();
  EXPECT_GE(simulation.advance(150).steps, 150U);
  EXPECT_EQ(allocation_count(), before);
}

TEST(Allocation, NoneInASteadyStep) {
  std::vector<Scene> scenes;
  for (const IntegratorId integrator : kIntegrators) scenes.push_back(make_shaken_vat(integrator));
  for (const StepControl control : {StepControl::adaptive, StepControl::local}) {
    scenes.push_back(make_shaken_vat(IntegratorId::velocity_verlet));
    scenes.back().numerics.control = control;
  }
  scenes.push_back(make_shaken_vat(IntegratorId::symplectic_euler));
  scenes.back().pressure_solver = PressureSolver::incompressible;
  for (Scene& scene : scenes) scene.vat->motion.reset();
  Scene wet = make_wet_vat(PressureSolver::tait);
  scenes.insert(scenes.end(), {wet, make_wet_vat(PressureSolver::incompressible)});
  wet.materials[0].liquid->surface_tension = 10;
  for (const SurfaceModel model : {SurfaceModel::curvature, SurfaceModel::cohesion}) {
    wet.surface_model = model;
    scenes.push_back(wet);
  }
  for (const Scene& scene : scenes) {
    SCOPED_TRACE(testing::Message()
                 << to_string(scene.numerics.integrator) << ' ' << to_string(scene.numerics.control)
                 << ' ' << to_string(scene.pressure_solver));
    Simulation simulation = make_simulation(scene);
    const bool is_wet = scene.bodies.size() == 1;
    if (scene.numerics.control == StepControl::fixed && !is_wet) {
      ASSERT_TRUE(simulation.grab_start(1, simulation.bodies()[2].id, 0, {0, 0, 0.3}).ok());
    }
    expect_no_allocations(simulation, is_wet ? 300 : 1500);
  }
}

TEST(Allocation, NoneInASteadyStepOfSeveralThreads) {
  for (const PressureSolver solver :
       {PressureSolver::gas, PressureSolver::tait, PressureSolver::incompressible}) {
    ThreadPoolRunner runner(4);
    SCOPED_TRACE(to_string(solver));
    Simulation simulation = make_simulation(make_wet_vat(solver, 8), &runner);  // several blocks
    expect_no_allocations(simulation, 250);
  }
}

}  // namespace
}  // namespace vat::test::allocation_test
