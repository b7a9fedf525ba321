#include "core/damping/damping_solve.h"

#include <gtest/gtest.h>

#include "core/stepping/stepper.h"
#include "tests/support/force_probe.h"
#include "tests/support/same_bits.h"
#include "tests/support/scenes.h"
#include "tests/support/totals.h"

namespace vat::test::damping_solve_test {
namespace {

constexpr Real kStep = 0.01;

/// A block of n^3 particles that move against one another. The damping of its springs exceeds the
/// stability limit of explicit steps of kStep.
Scene make_damped_block(int n = 3) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, kStep, {make_material("gum")});
  ParticleShape shape = make_particles(make_lattice(n, n, n, 0.1), 0.1);
  for (std::size_t i = 0; i < shape.positions.size(); ++i) {
    const auto x = static_cast<Real>(i);
    shape.velocities.push_back(0.1 * Vec3(std::sin(x), std::cos(2 * x), std::sin(3 * x)));
  }
  scene.bodies = {make_body("block", BodyKind::deformable, "gum", shape, 0.01)};
  const auto& positions = std::get<ParticleShape>(scene.bodies[0].shape).positions;
  scene.bodies[0].springs = join_near(positions, 0.15, {1, 5});
  return scene;
}

/// A viscous drop with nu dt / h^2 = 1.
Scene make_viscous_drop() {
  Scene scene =
      make_scene(IntegratorId::velocity_verlet, kStep, {make_liquid("tar", 1000, {1, 4000, 0.2})});
  ParticleShape shape = make_particles(make_lattice(6, 6, 6, 0.1), 1);
  for (const Vec3& x : shape.positions) shape.velocities.push_back({x.z(), 0, -x.x() * x.x()});
  scene.bodies = {make_body("drop", BodyKind::liquid, "tar", shape, 0.05)};
  return scene;
}

/// A viscous liquid in an endless channel. Floor and lid move and drag the liquid along.
Scene make_viscous_channel() {
  Scene scene =
      make_scene(IntegratorId::velocity_verlet, kStep, {make_liquid("tar", 1000, {1, 4000, 0.2})});
  scene.dimensions = 2;
  scene.periodic = Periodicity{Vec3::Zero(), Vec3(1, 1, 1), {true, false, false}};
  scene.vat = Vat{Vec3::Zero(), Vec3(1, 1, 0.6), true, {}, {}};
  scene.vat->walls[4] = {true, Vec3::Zero()};
  scene.vat->walls[5] = {true, Vec3(2, 0, 0)};
  ParticleShape shape;
  for (int n = 0; n < 60; ++n) {
    shape.positions.push_back({0.05 + 0.1 * (n % 10), 0, 0.05 + 0.1 * std::floor(n / 10)});
    shape.velocities.push_back({std::sin(n), 0, std::cos(n)});
  }
  shape.masses.assign(60, 10);
  scene.bodies = {make_body("channel", BodyKind::liquid, "tar", shape, 0.05)};
  return scene;
}

/// Two rigid bars and a ball of the block's body kind, pressed together through strong dampers.
Scene make_damped_contacts() {
  Scene scene = make_damped_block();
  scene.materials.push_back(make_material("steel"));
  scene.default_interface = {10, 50};
  for (const Real side : {-1.0, 1.0}) {
    ParticleShape bar = make_particles(make_lattice(5, 1, 1, 0.1), 0.2);
    scene.bodies.push_back(
        make_body(side < 0 ? "low" : "high", BodyKind::rigid, "steel", bar, 0.05));
    scene.bodies.back().position = Vec3(0.03, 0.02, side * 0.14);
    scene.bodies.back().velocity = Vec3(0, 0, -side);
    scene.bodies.back().angular_velocity = Vec3(0, side, 0.5);
  }
  return scene;
}

/// Takes one step of velocity Verlet. Returns the relative difference between the forces that the
/// step stored at its end and the forces of the velocities at its end.
Real force_error(const Scene& scene) {
  ForceProbe probe(scene);
  const Model& model = probe.model();
  const Controls controls;
  Workspace work;
  const ForceModel force_model{model, controls, work};
  State state = probe.state();
  state.forces_current = false;
  const GuardBounds guard = guard_bounds(model);
  const StepBounds bounds = find_step_bounds(model);
  AdvanceReport report;
  Stepper stepper;
  EXPECT_TRUE(stepper.take_nominal_step({force_model, state, guard, bounds, report}));
  EXPECT_EQ(report.undone_steps, 0U);
  EXPECT_TRUE(must_solve_damping(state.bound, kStep));
  const std::vector<Vec3> kept = state.forces.particle;
  force_model.evaluate(state.now, kStep, state.forces);
  Real wrong = 0;
  Real whole = 0;
  for (Index i = 0; i < model.free_count; ++i) {
    wrong += (kept[i] - state.forces.particle[i]).squaredNorm();
    whole += kept[i].squaredNorm();
  }
  return std::sqrt(wrong / whole);
}

// The solver finds velocities to 1 %. The damping of the remainder is at most half of rate * dt =
// 16 of that.
TEST(DampingSolve, VelocitiesAreThoseThatTheirOwnDampingLeadsTo) {
  EXPECT_LT(force_error(make_damped_block()), 0.08);
  EXPECT_LT(force_error(make_damped_block(8)), 0.08);  // more than one block of particles
  EXPECT_LT(force_error(make_viscous_drop()), 0.08);
  EXPECT_LT(force_error(make_viscous_channel()), 0.08);
}

TEST(DampingSolve, TakesEnergyAndKeepsMomenta) {
  for (const Scene& scene : {make_damped_block(), make_viscous_drop(), make_damped_contacts()}) {
    Simulation simulation = make_simulation(scene);
    const Diagnostics start = simulation.diagnostics();
    const Totals before = totals_of(start);
    Real energy = start.kinetic_energy + start.elastic_energy + start.contact_energy;
    for (int n = 0; n < 100; ++n) {
      ASSERT_TRUE(simulation.advance(1).events.empty());
      const Diagnostics now = simulation.diagnostics();
      const Real left = now.kinetic_energy + now.elastic_energy + now.contact_energy;
      // Diagnostics do not include the energy of a compressed liquid.
      if (scene.bodies[0].kind != BodyKind::liquid) {
        EXPECT_LT(left, energy * (1 + 1e-9)) << n;
      }
      energy = left;
      const Totals after = totals_of(now);
      EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12);
      // Viscosity acts along velocities, not along the line between particles, so it does not
      // conserve angular momentum.
      if (scene.bodies[0].kind != BodyKind::liquid) {
        EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(), 1e-12);
      }
    }
    EXPECT_LT(energy, 0.5 * start.kinetic_energy);
  }
}

// The forces at the start of a step of free fall predict the velocities at its end.
TEST(DampingSolve, StartsFromPredictedVelocities) {
  Scene scene = make_viscous_drop();
  std::get<ParticleShape>(scene.bodies[0].shape).velocities.clear();
  scene.materials[0].liquid->stiffness = 0;  // no pressure, which accelerates the drop's surface
  scene.gravity = Vec3(0, 0, -9.81);
  Simulation simulation = make_simulation(scene);
  simulation.advance(1);
  for (int n = 0; n < 10; ++n) EXPECT_EQ(simulation.advance(1).iterations.damping, 0U) << n;
  const BodyDiagnostics drop = simulation.diagnostics().bodies[0];
  EXPECT_NEAR(drop.linear_momentum.z(), -9.81 * drop.mass * simulation.time(), 1e-9 * drop.mass);
}

TEST(DampingSolve, DoesNotMoveAHeldBody) {
  Scene scene = make_damped_contacts();
  scene.bodies[1].fixed = true;
  scene.bodies[1].velocity = scene.bodies[1].angular_velocity = Vec3::Zero();
  Simulation simulation = make_simulation(scene);
  const Vec3 start = position_of(simulation, 1);
  EXPECT_GT(simulation.diagnostics().bodies[1].outer_force.norm(), 0);
  simulation.advance(50);
  EXPECT_EQ(position_of(simulation, 1), start);
}

TEST(DampingSolve, LightDampingNeedsNone) {
  Scene scene = make_damped_block();
  scene.bodies[0].springs =
      join_near(std::get<ParticleShape>(scene.bodies[0].shape).positions, 0.15, {1, 0.01});
  ForceProbe probe(scene);
  const Controls controls;
  Workspace work;
  const ForceModel force_model{probe.model(), controls, work};
  force_model.evaluate(probe.state().now, 0, probe.state().forces);
  const Oscillation bound = find_bound(force_model, probe.state().now);
  EXPECT_GT(bound.rate, 0);
  EXPECT_FALSE(must_solve_damping(bound, kStep));
}

// The liquid feels bodies by its pressure only. It fills the first blocks.
TEST(DampingSolve, LeavesOutBlocksWithoutDampers) {
  Scene scene = make_damped_contacts();
  scene.pressure_solver = PressureSolver::tait;
  scene.materials.push_back(make_liquid("water", 1000, {400, 0, 0.2}));
  const ParticleShape shape = make_particles(make_lattice(8, 8, 8, 0.1), 1);
  scene.bodies.erase(scene.bodies.begin());  // the block, whose springs have dampers
  scene.bodies[1].position.z() = scene.bodies[0].position.z() + 0.08;
  scene.bodies.push_back(make_body("pool", BodyKind::liquid, "water", shape, 0.05));
  scene.bodies.back().position = {5, 0, 0};
  ForceProbe probe(scene);
  ASSERT_EQ(probe.model().liquid_count, 2 * kBlockSize);
  const Controls controls;
  Workspace work;
  work.keep_dampers = true;
  const ForceModel f{probe.model(), controls, work};
  State& state = probe.state();
  f.evaluate(state.now, 0, state.forces);
  DampingMatrix matrix;
  matrix.collect({f.model, controls, 0, 0, state.now, state.forces, work, nullptr}, false);
  EXPECT_EQ(matrix.blocks(), std::vector<std::size_t>{2});
  EXPECT_FALSE(matrix.rigid_particles().empty());
}

TEST(DampingSolve, GivesTheSameBitsForAnyNumberOfThreads) {
  Scene scene = make_damped_block(9);
  scene.materials.push_back(make_viscous_drop().materials[0]);
  ParticleShape shape = make_particles(make_lattice(9, 9, 9, 0.1), 1);
  for (const Vec3& x : shape.positions) shape.velocities.push_back({x.z(), x.x(), 0});
  scene.bodies.push_back(make_viscous_drop().bodies[0]);
  scene.bodies[1].shape = shape;
  scene.bodies[1].position = {2, 0, 0};
  expect_same_bits(scene, 5, 1);
}

}  // namespace
}  // namespace vat::test::damping_solve_test
