// A body that is put elsewhere is compiled alone: the model is what compile() makes of the scene in
// which it begins there.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/model/compile.h"
#include "core/scene/choose_numerics.h"
#include "core/step/step_control.h"
#include "tests/support/edited_scene.h"
#include "tests/support/saved_bits.h"

namespace vat::moved_body_test {
namespace {

using namespace test;

/// What a SpringEnd and the like hold, for comparisons.
auto values_of(Index i) {
  return i;
}
auto values_of(Real x) {
  return x;
}
auto values_of(const Vec3& v) {
  return std::array{v.x(), v.y(), v.z()};
}
auto values_of(const SpringEnd& end) {
  return std::tuple(end.other, end.stiffness, end.damping, end.rest_length);
}
auto values_of(const LimitedSpring& spring) {
  return std::tuple(spring.a, spring.b, spring.end, spring.greatest);
}
auto values_of(const VolumeCell& cell) {
  return std::tuple(cell.corners, cell.volume, cell.bulk_modulus);
}
auto values_of(const CellCorner& corner) {
  return std::tuple(corner.cell, corner.corner);
}
auto values_of(const Oscillation& oscillation) {
  return std::tuple(oscillation.omega2, oscillation.rate);
}

template <class Column>
void expect_same(const Column& column, const Column& other, const char* name) {
  ASSERT_EQ(column.size(), other.size()) << name;
  for (std::size_t i = 0; i < column.size(); ++i) {
    ASSERT_TRUE(values_of(column[i]) == values_of(other[i])) << name << ' ' << i;
  }
}

void expect_same_rigid_bodies(const Model& model, const Model& other) {
  ASSERT_EQ(model.rigid_bodies.size(), other.rigid_bodies.size());
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    const RigidModel& one = model.rigid_bodies[b];
    const RigidModel& same = other.rigid_bodies[b];
    EXPECT_EQ(one.body, same.body);
    EXPECT_EQ(one.particles.begin, same.particles.begin);
    EXPECT_EQ(one.inverse_mass, same.inverse_mass);
    EXPECT_EQ(one.inertia, same.inertia);
    EXPECT_EQ(one.inverse_inertia, same.inverse_inertia);
    EXPECT_EQ(one.principal_axes.coeffs(), same.principal_axes.coeffs());
    EXPECT_EQ(one.inverse_moments, same.inverse_moments);
    EXPECT_EQ(one.splitting, same.splitting);
    EXPECT_EQ(one.free_from, same.free_from);
  }
}

void expect_same_model(const Model& model, const Model& other) {
  expect_same(model.mass, other.mass, "mass");
  expect_same(model.inverse_mass, other.inverse_mass, "inverse_mass");
  expect_same(model.radius, other.radius, "radius");
  expect_same(model.body, other.body, "body");
  expect_same(model.rest_volume, other.rest_volume, "rest_volume");
  expect_same(model.local_position, other.local_position, "local_position");
  expect_same(model.spring_begin, other.spring_begin, "spring_begin");
  expect_same(model.spring_own_begin, other.spring_own_begin, "spring_own_begin");
  expect_same(model.spring_ends, other.spring_ends, "spring_ends");
  expect_same(model.cells, other.cells, "cells");
  expect_same(model.cell_begin, other.cell_begin, "cell_begin");
  expect_same(model.cell_corners, other.cell_corners, "cell_corners");
  expect_same(model.limited_springs, other.limited_springs, "limited_springs");
  expect_same(model.limited_begin, other.limited_begin, "limited_begin");
  expect_same(model.exclusion_begin, other.exclusion_begin, "exclusion_begin");
  expect_same(model.exclusions, other.exclusions, "exclusions");
  expect_same(model.damping.own, other.damping.own, "damping");
  EXPECT_EQ(model.damping.any, other.damping.any);
  EXPECT_TRUE(model.damping.is_current);
  EXPECT_EQ(model.is_filled, other.is_filled);
  EXPECT_EQ(model.contact_reach, other.contact_reach);
  EXPECT_EQ(to_text(model.plan), to_text(other.plan));
  expect_same_rigid_bodies(model, other);
}

void expect_same_bounds(const StepBounds& bounds, const StepBounds& other) {
  expect_same(bounds.own, other.own, "own");
  expect_same(bounds.own_step, other.own_step, "own_step");
  EXPECT_EQ(bounds.scene_step, other.scene_step);
}

std::shared_ptr<Model> compile_fresh(Scene scene) {
  resolve_accuracy(scene);
  std::vector<BodyId> ids(scene.bodies.size());
  std::iota(ids.begin(), ids.end(), BodyId{1});
  std::vector<std::shared_ptr<const SampledBody>> samples(ids.size());
  return compile(std::move(scene), ids, std::move(samples));
}

BodyDescription put_elsewhere(BodyDescription body) {
  body.position += Vec3(0.0123, -0.0456, 0.0789);
  body.velocity = {0.1, 0.2, -0.3};
  if (body.kind != BodyKind::rigid) return body;
  body.orientation = Quat(Eigen::AngleAxis<Real>(1.1, Vec3(3, -1, 2).normalized()));
  return body;
}

/// Moves each body of the scene as it is when gravity has become `gravity`.
void expect_compiled_there(const Scene& scene, const Vec3& gravity) {
  const std::shared_ptr<Model> before = compile_fresh(scene);
  const StepBounds bounds = find_step_bounds(*before);
  forget_samples(*before);
  if (gravity != scene.gravity) {
    before->scene.gravity = gravity;
    before->damping.is_current = false;
  }
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    SCOPED_TRACE(scene.bodies[b].name);
    Scene changed = scene;
    changed.gravity = gravity;
    changed.bodies[b] = put_elsewhere(scene.bodies[b]);
    const std::shared_ptr<Model> moved = with_moved_body(*before, b, changed.bodies[b]);
    const std::shared_ptr<Model> fresh = compile_fresh(changed);
    expect_same_model(*moved, *fresh);
    expect_same_bounds(step_bounds_of_moved(*moved, b, bounds), find_step_bounds(*fresh));
  }
}

/// With everything that a deformable body may have, twice. Radii reach to about the diagonals of
/// the lattice, which no springs join, and a field stretches it: what is close depends on its
/// place.
Scene scene_of_cubes(StepControl control) {
  Scene scene = sampled_scene();
  scene.pressure_solver = PressureSolver::gas;
  scene.numerics.control = control;
  Material& jelly = scene.materials[1];
  jelly.springs->shear.reset();
  jelly.self_contact = SpringConstants{100, 0.1};
  jelly.bulk_modulus = 500;
  jelly.elongation_limit = 0.1;
  BodyDescription& cube = scene.bodies[1];
  cube.radius = cube.spacing / std::sqrt(2.0);
  cube.displacement_field =
      VectorField{.waves = {{.amplitude = {0.01, 0, 0.01}, .wave_vector = {30, 20, 0}}}};
  scene.bodies.push_back(cube);
  scene.bodies.back().name = "second cube";
  scene.bodies.back().position = {0.7, 0.3, 0.3};
  return scene;
}

TEST(MovedBody, IsCompiledAsIfItHadBegunThere) {
  for (const PressureSolver solver :
       {PressureSolver::gas, PressureSolver::tait, PressureSolver::incompressible}) {
    Scene scene = sampled_scene();
    scene.pressure_solver = solver;
    scene.numerics.integrator = IntegratorId::symplectic_euler;
    expect_compiled_there(scene, scene.gravity);
  }
}

TEST(MovedBody, IsCompiledWithAllThatDeformableBodiesHave) {
  for (const StepControl control :
       {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
    const Scene scene = scene_of_cubes(control);
    expect_compiled_there(scene, scene.gravity);
    const Model before = *compile_fresh(scene);
    const BodyDescription moved = put_elsewhere(scene.bodies[1]);
    EXPECT_FALSE(
        std::ranges::equal(with_moved_body(before, 1, moved)->exclusions, before.exclusions));
  }
}

// The damping that limits their steps is that under the gravity of the last change.
TEST(MovedBody, LeavesLiquidsUnderTheGravityThatThereIsNow) {
  Scene scene = sampled_scene();
  scene.pressure_solver = PressureSolver::incompressible;
  scene.numerics.integrator = IntegratorId::symplectic_euler;
  scene.numerics.control = StepControl::adaptive;
  expect_compiled_there(scene, {1, 2, -30});
}

/// Bodies whose particles' places, and their sums, are whole parts of a power of two: no sum of
/// them is rounded.
Scene exact_scene(StepControl control) {
  Scene scene = sampled_scene();
  scene.pressure_solver = PressureSolver::gas;
  scene.numerics.control = control;
  scene.materials[1].self_contact = SpringConstants{100, 0.1};
  scene.materials[2].density = 512;
  for (BodyDescription& body : scene.bodies) {
    body.spacing = 1.0 / 16;
    body.shape = BoxShape{Vec3::Zero(), Vec3::Constant(4.0 / 16)};
    body.mass = 64;
    body.orientation = Quat::Identity();
    body.angular_velocity = Vec3::Zero();
  }
  scene.bodies[0].position = {0.25, 0.25, 0.25};
  scene.bodies[1].position = {0.75, 0.75, 0.25};
  scene.bodies[2].position = {0.25, 0.75, 0.25};
  return scene;
}

TEST(MovedBody, GoesOnAsInAWorldThatIsCompiledWithItThere) {
  for (const StepControl control :
       {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
    for (std::size_t body = 0; body < 3; ++body) {
      SCOPED_TRACE(testing::Message() << "body " << body << ", control " << to_string(control));
      Simulation moved = make_simulation(exact_scene(control));
      const Vec3 target = exact_scene(control).bodies[body].position + Vec3(0, 0, 0.25);
      ASSERT_TRUE(moved.move_body(moved.bodies()[body].id, {target, {}, {}}).ok());
      Scene scene = exact_scene(control);
      scene.bodies[body].position = target;
      Simulation fresh = make_simulation(scene);
      ASSERT_EQ(moved.state_hash(), fresh.state_hash());
      for (int tick = 0; tick < 300; ++tick) {
        moved.advance(1);
        fresh.advance(1);
        ASSERT_EQ(moved.state_hash(), fresh.state_hash()) << "tick " << tick;
      }
      EXPECT_NE(moved.state_hash(), make_simulation(scene).state_hash());
    }
  }
}

TEST(MovedBody, GoesOnFromItsBytesWithAllThatDeformableBodiesHave) {
  Simulation simulation = make_simulation(scene_of_cubes(StepControl::adaptive));
  simulation.advance(5);
  ASSERT_TRUE(simulation.move_body(simulation.bodies()[1].id, {{0.6, 0.7, 0.5}, {}, {}}).ok());
  expect_goes_on(simulation, 40);
}

Vec3 center_of(const BodyView& body) {
  Vec3 sum = Vec3::Zero();
  Real mass = 0;
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    sum += body.masses[i] * body.positions[i];
    mass += body.masses[i];
  }
  return sum / mass;
}

/// Puts the body where it is, and a material that it does not have as it is: after that all is
/// compiled.
void expect_same_as_compiling_all(Simulation& moved, std::size_t body, const Material& material) {
  Simulation other = make_simulation(moved.scene());
  other.restore(moved.snapshot());
  const BodyView view = moved.bodies()[body];
  ASSERT_TRUE(moved.move_body(view.id, {center_of(view), {}, {}}).ok());
  ASSERT_TRUE(other.set_material(material).ok());
  for (int step = 0; step < 30; ++step) {
    ASSERT_EQ(moved.state_hash(), other.state_hash()) << "step " << step;
    moved.advance(1);
    other.advance(1);
  }
}

TEST(MovedBody, KeepsAndForgetsWhatCompilingAllKeepsAndForgets) {
  for (const StepControl control : {StepControl::fixed, StepControl::adaptive}) {
    Scene scene = sampled_scene();
    scene.pressure_solver = PressureSolver::gas;
    scene.numerics.control = control;
    scene.materials[1].plasticity = Plasticity{.yield_strain = 0.01};
    scene.default_interface.law = InterfaceLaw::projection;
    scene.sleeping = Sleeping{};
    Simulation simulation = make_simulation(scene);
    simulation.advance(250);  // all have fallen
    expect_same_as_compiling_all(simulation, 1, scene.materials[2]);
    expect_same_as_compiling_all(simulation, 0, scene.materials[2]);
  }
}

}  // namespace
}  // namespace vat::moved_body_test
