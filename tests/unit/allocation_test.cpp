#include <gtest/gtest.h>

#include "tests/support/shaken_vat.h"
#include "tests/unit/allocation_counter.h"

namespace vat {
namespace {

using namespace test;

TEST(Allocation, IsCounted) {
  const std::size_t before = allocation_count();
  const std::vector<int> numbers(1000);
  EXPECT_EQ(allocation_count(), before + 1);
  EXPECT_EQ(numbers.back(), 0);
}

// Once every buffer has the size that the scene needs: the bodies rest on one another.
TEST(Allocation, NoneInASteadyStep) {
  for (const IntegratorId integrator : kIntegrators) {
    Scene scene = make_shaken_vat(integrator);
    scene.vat->motion.reset();
    Simulation simulation = make_simulation(scene);
    ASSERT_TRUE(simulation.grab_start(1, simulation.bodies()[2].id, 0, {0, 0, 0.3}).ok());
    ASSERT_TRUE(simulation.advance(2000).events.empty());
    const std::size_t before = allocation_count();
    const AdvanceReport report = simulation.advance(200);
    EXPECT_EQ(allocation_count(), before) << to_string(integrator);
    EXPECT_EQ(report.steps, 200U);
  }
}

TEST(Allocation, NoneInASteadyStepOfVariedLength) {
  for (const StepControl control : {StepControl::adaptive, StepControl::local}) {
    Scene scene = make_shaken_vat(IntegratorId::velocity_verlet);
    scene.vat->motion.reset();
    scene.numerics.control = control;
    Simulation simulation = make_simulation(scene);
    for (int n = 0; n < 2; ++n) {  // the second call copies what the first has added to the state
      ASSERT_TRUE(simulation.advance(1500).events.empty());
    }
    const std::size_t before = allocation_count();
    simulation.advance(200);
    EXPECT_EQ(allocation_count(), before) << to_string(control);
  }
}

TEST(Allocation, NoneInASteadyStepOfAnIncompressibleLiquid) {
  Scene scene = make_shaken_vat(IntegratorId::symplectic_euler);
  scene.vat->motion.reset();
  scene.pressure_solver = PressureSolver::incompressible;
  Simulation simulation = make_simulation(scene);
  simulation.advance(2000);
  const std::size_t before = allocation_count();
  simulation.advance(200);
  EXPECT_EQ(allocation_count(), before);
}

/// A cube of thick liquid on the floor of a vat, with a speed of sound of 10 m/s.
Scene make_wet_vat(PressureSolver solver) {
  constexpr Real kSpacing = 0.1;
  const bool is_tait = solver == PressureSolver::tait;
  Scene scene =
      make_scene(is_tait ? IntegratorId::velocity_verlet : IntegratorId::symplectic_euler, 2e-3);
  scene.pressure_solver = solver;
  scene.materials = {make_liquid("honey", 1000, {100, 1000, 3 * kSpacing})};
  scene.bodies = {make_body("honey", BodyKind::liquid, "honey",
                            make_particles(make_lattice(5, 5, 5, kSpacing), 1), kSpacing / 2)};
  scene.vat = Vat{{-1, -1, -0.25}, {1, 1, 1}, true, {}, {}};
  return scene;
}

void expect_no_allocations(const Scene& scene) {
  Simulation simulation = make_simulation(scene);
  ASSERT_TRUE(simulation.advance(500).events.empty());
  const std::size_t before = allocation_count();
  simulation.advance(100);
  EXPECT_EQ(allocation_count(), before);
}

TEST(Allocation, NoneInASteadyStepThatSolvesForViscosity) {
  expect_no_allocations(make_wet_vat(PressureSolver::tait));
  expect_no_allocations(make_wet_vat(PressureSolver::incompressible));
}

TEST(Allocation, NoneInASteadyStepOfASurface) {
  Scene scene = make_wet_vat(PressureSolver::tait);
  scene.materials[0].liquid->surface_tension = 10;
  for (const SurfaceModel model : {SurfaceModel::curvature, SurfaceModel::cohesion}) {
    scene.surface_model = model;
    expect_no_allocations(scene);
  }
}

}  // namespace
}  // namespace vat
