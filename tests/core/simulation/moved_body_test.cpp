// Moving a body compiles only that body. The result equals a compilation of all bodies.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/edited_scene.h"
#include "tests/support/saved_bits.h"

namespace vat::test::moved_body_test {
namespace {

/// Moves a body in two simulations with the same state, and recompiles one of them by setting a
/// material that the body does not use. Expects the same bits from both.
void expect_same_as_compiling_all(const Simulation& simulation, std::size_t body,
                                  const Vec3& shift) {
  Simulation moved = make_simulation(simulation.scene());
  Simulation other = make_simulation(simulation.scene());
  const BodyView view = simulation.bodies()[body];
  BodyPlacement place;
  place.center_of_mass = simulation.diagnostics().bodies[body].center_of_mass + shift;
  place.velocity = Vec3(0.1, 0.2, -0.3);
  if (view.kind == BodyKind::rigid) {
    place.orientation = Quat(Eigen::AngleAxis<Real>(1.1, Vec3(3, -1, 2).normalized()));
  }
  for (Simulation* each : {&moved, &other}) {
    each->restore(simulation.snapshot());
    ASSERT_TRUE(each->move_body(view.id, place).ok());
  }
  const auto& materials = simulation.scene().materials;
  const auto unrelated = std::ranges::find_if(
      materials, [&](const Material& material) { return material.name != view.material; });
  ASSERT_TRUE(other.set_material(*unrelated).ok());
  for (int step = 0; step < 30; ++step) {
    ASSERT_EQ(moved.state_hash(), other.state_hash()) << "step " << step;
    moved.advance(1);
    other.advance(1);
  }
}

void expect_same_as_compiling_all(const Simulation& simulation,
                                  const Vec3& shift = {0.0123, -0.0456, 0.2}) {
  for (std::size_t body = 0; body < simulation.bodies().size(); ++body) {
    SCOPED_TRACE(simulation.bodies()[body].name);
    expect_same_as_compiling_all(simulation, body, shift);
  }
}

TEST(MovedBody, IsCompiledWithEveryPressureSolver) {
  for (const PressureSolver solver :
       {PressureSolver::gas, PressureSolver::tait, PressureSolver::incompressible}) {
    SCOPED_TRACE(to_string(solver));
    Scene scene = sampled_scene();
    scene.pressure_solver = solver;
    scene.numerics.integrator = IntegratorId::symplectic_euler;
    expect_same_as_compiling_all(make_simulation(scene));
  }
}

// The damping that limits the steps of an incompressible liquid uses the gravity of the last
// change.
TEST(MovedBody, LeavesLiquidsUnderThePresentGravity) {
  Scene scene = sampled_scene();
  scene.pressure_solver = PressureSolver::incompressible;
  scene.numerics.integrator = IntegratorId::symplectic_euler;
  scene.numerics.control = StepControl::adaptive;
  Simulation simulation = make_advanced(scene, 5);
  ASSERT_TRUE(simulation.set_gravity({1, 2, -30}).ok());
  expect_same_as_compiling_all(simulation);
}

/// Two deformable bodies with all optional features. Particle radii reach the lattice diagonals,
/// which have no springs, and a field stretches the lattice. The set of close particles therefore
/// depends on the position.
Scene scene_of_cubes(StepControl control) {
  Scene scene = sampled_scene();
  scene.pressure_solver = PressureSolver::gas;
  scene.numerics.control = control;
  Material& jelly = scene.materials[1];
  jelly.springs->shear.reset();
  jelly.self_contact = SpringConstants{100, 0.1};
  if (control != StepControl::local) {
    jelly.bulk_modulus = 500;
    jelly.elongation_limit = 0.1;
  }
  BodyDescription& cube = scene.bodies[1];
  cube.radius = cube.spacing / std::sqrt(2.0);
  cube.displacement_field =
      VectorField{.waves = {{.amplitude = {0.01, 0, 0.01}, .wave_vector = {30, 20, 0}}}};
  scene.bodies.push_back(cube);
  scene.bodies.back().name = "second cube";
  scene.bodies.back().position = {0.7, 0.3, 0.3};
  return scene;
}

TEST(MovedBody, IsCompiledWithAllThatDeformableBodiesHave) {
  for (const StepControl control :
       {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
    SCOPED_TRACE(to_string(control));
    Simulation simulation = make_simulation(scene_of_cubes(control));
    expect_same_as_compiling_all(simulation);
    simulation.advance(5);
    expect_same_as_compiling_all(simulation);
  }
}

TEST(MovedBody, ADeformableOneContinuesFromItsBytes) {
  Simulation simulation = make_advanced(scene_of_cubes(StepControl::adaptive), 5);
  ASSERT_TRUE(simulation.move_body(simulation.bodies()[1].id, {{0.6, 0.7, 0.5}, {}, {}}).ok());
  expect_goes_on(simulation, 40);
}

TEST(MovedBody, KeepsAndForgetsTheStateThatCompilingAllKeepsAndForgets) {
  for (const StepControl control : {StepControl::fixed, StepControl::adaptive}) {
    Scene scene = sampled_scene();
    scene.pressure_solver = PressureSolver::gas;
    scene.numerics.control = control;
    scene.materials[1].plasticity = Plasticity{.yield_strain = 0.01};
    scene.default_interface.law = InterfaceLaw::projection;
    scene.sleeping = Sleeping{};
    Simulation simulation = make_advanced(scene, 250);  // all bodies have fallen
    expect_same_as_compiling_all(simulation, {0, 0, 0.1});
  }
}

}  // namespace
}  // namespace vat::test::moved_body_test
