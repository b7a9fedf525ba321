#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "core/limits.h"
#include "core/sampling/nozzle.h"
#include "core/validation/validate.h"
#include "tests/support/errors.h"
#include "tests/support/name_of.h"
#include "tests/support/scenes.h"
#include "tests/support/thread_runner.h"

// Emitters and drains.

namespace vat::test::flow_test {
namespace {

constexpr Real kSpacing = 0.05;
constexpr Real kSpeed = 0.75;
constexpr Real kStep = 0.002;
constexpr std::size_t kStart = 4 * 4;  // particles of the pool

/// A puddle, and above it a horizontal square nozzle of 3 x 3 particles that points along x.
Scene make_flow_scene(IntegratorId integrator = IntegratorId::velocity_verlet) {
  Scene scene = make_scene(integrator, kStep);
  scene.numerics.tick = 10 * kStep;
  scene.pressure_solver = PressureSolver::tait;
  scene.gravity = {0, 0, -10};
  scene.materials = {make_liquid("water", 1000, {.stiffness = 100, .support_radius = 0.125}),
                     make_material("wood", 500)};
  BodyDescription pool{"pool", BodyKind::liquid, "water",
                       BoxShape{{0.5, 0.5, 0.03}, {0.2, 0.2, 0.05}}, kSpacing};
  BodyDescription ball = make_body("ball", BodyKind::rigid, "wood",
                                   make_particles(make_lattice(3, 3, 3, kSpacing), 0.05), 0.025);
  ball.position = {0.9, 0.5, 0.1};
  scene.bodies = {pool, ball};
  scene.vat = Vat{{0, 0, 0}, {1.5, 1, 1}, false, {}, {}};
  scene.emitters = {{.name = "tap",
                     .body = "pool",
                     .position = {0.2, 0.5, 0.5},
                     .direction = {2, 0, 0},
                     .size = {{3 * kSpacing, 3 * kSpacing}},
                     .speed = kSpeed,
                     .most_particles = 5000}};
  return scene;
}

Drain make_floor_drain() {
  return {"hole", {0, 0, 0}, {1.5, 1, 0.06}};
}

std::size_t pool_size(const Simulation& simulation) {
  return simulation.bodies()[0].positions.size();
}

/// Returns the number of pool particles that have exactly the nozzle's velocity.
std::size_t count_steady(const Simulation& simulation) {
  return static_cast<std::size_t>(
      std::ranges::count(simulation.bodies()[0].velocities, Vec3(kSpeed, 0, 0)));
}

class Flows : public testing::TestWithParam<IntegratorId> {};

// The flow rate is speed times area, and the tube in front of the opening is full.
TEST_P(Flows, WithSpeedTimesAreaToTheParticle) {
  Simulation simulation = make_simulation(make_flow_scene(GetParam()));
  constexpr std::size_t kTube = 3;  // layers: 0.125 / 0.05, rounded up
  for (int tick = 1; tick <= 20; ++tick) {
    ASSERT_TRUE(simulation.advance(10).events.empty());
    // The last step started one step ago.
    const Real time = simulation.time() - kStep;
    const auto layers = static_cast<std::size_t>(kSpeed * time / kSpacing + 1e-6) + 1 + kTube;
    ASSERT_EQ(simulation.diagnostics().emitted_particles, 9 * layers) << tick;
    ASSERT_EQ(pool_size(simulation), kStart + 9 * layers);
    ASSERT_EQ(simulation.particle_count(), pool_size(simulation) + 27);
  }
}

TEST_P(Flows, InLayersASpacingApart) {
  Scene scene = make_flow_scene(GetParam());
  scene.gravity = Vec3::Zero();
  Simulation simulation = make_advanced(scene, 73);
  // No force acts on the particles. Each layer is at the position that follows from its start time.
  const BodyView pool = simulation.bodies()[0];
  std::vector<Real> places;
  for (std::size_t i = kStart; i < pool.positions.size(); i += 9) {
    places.push_back(pool.positions[i].x());
    EXPECT_NEAR(pool.masses[i], 0.125, 1e-15);
    EXPECT_EQ(pool.radii[i], kSpacing / 2);
  }
  const Real first = 0.2 + kSpeed * simulation.time();
  for (std::size_t layer = 0; layer < places.size(); ++layer) {
    EXPECT_NEAR(places[layer], first - static_cast<Real>(layer) * kSpacing, 2e-3) << layer;
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, Flows, testing::ValuesIn(kIntegrators), NameOf());

TEST(Flow, InTheTubeIsSteadyForEachDrive) {
  Scene scene = make_flow_scene();
  // A block of liquid in front of the opening.
  scene.bodies[0].shape = BoxShape{{0.4, 0.5, 0.5}, {0.3, 0.5, 0.5}};
  Simulation simulation = make_advanced(scene, 100);
  EXPECT_GE(count_steady(simulation), 9U * 2);
  EXPECT_LE(count_steady(simulation), 9U * 4);
}

TEST(Flow, BeginsAndEndsOnTime) {
  Scene scene = make_flow_scene();
  scene.emitters[0].from = 0.2;
  scene.emitters[0].until = 0.4;  // three intervals
  Simulation simulation = make_advanced(scene, 1);
  EXPECT_EQ(pool_size(simulation), kStart + 9);  // the first three layers enter until 0.2 s
  simulation.advance(299);
  EXPECT_EQ(pool_size(simulation), kStart + 3 * 9);
  EXPECT_EQ(count_steady(simulation), 0U);
}

TEST(Flow, StopsAndContinuesByCommand) {
  Scene scene = make_flow_scene();
  scene.emitters[0].open = false;
  Simulation simulation = make_advanced(scene, 50);
  EXPECT_EQ(pool_size(simulation), kStart);
  const std::uint64_t closed = simulation.state_hash();
  EXPECT_EQ(simulation.set_emitter("hose", true).errors().at(0).path, "/emitter");
  EXPECT_EQ(simulation.state_hash(), closed);
  ASSERT_TRUE(simulation.set_emitter("tap", true).ok());
  EXPECT_NE(simulation.state_hash(), closed);
  simulation.advance(100);
  EXPECT_EQ(pool_size(simulation), kStart + 3 * 9);  // one layer per 33 steps
  ASSERT_TRUE(simulation.set_emitter("tap", false).ok());
  simulation.advance(150);
  EXPECT_EQ(pool_size(simulation), kStart + 3 * 9);
  EXPECT_EQ(count_steady(simulation), 0U);  // the tube is empty
}

TEST(Flow, StopsAtAFullBodyAndContinuesWithRoom) {
  Scene scene = make_flow_scene();
  scene.emitters[0].most_particles = kStart + 50;
  Simulation simulation = make_advanced(scene, 300);
  EXPECT_EQ(pool_size(simulation), kStart + 45);
  EXPECT_EQ(simulation.greatest_particle_count(), kStart + 50 + 27);
  scene.drains = {make_floor_drain()};
  Simulation drained = make_simulation(scene);
  for (int tick = 0; tick < 100; ++tick) {
    ASSERT_TRUE(drained.advance(10).events.empty());
    ASSERT_LE(pool_size(drained), kStart + 50);
  }
  EXPECT_GT(drained.diagnostics().emitted_particles, 200U);
}

// Remaining particles keep their numbers, and new particles get the next numbers.
TEST(Flow, KeepsTheBooksAndNumbersParticles) {
  Scene scene = make_flow_scene();
  scene.drains = {make_floor_drain()};
  Simulation simulation = make_simulation(scene);
  const auto places = [&] {
    const BodyView pool = simulation.bodies()[0];
    std::map<Index, Vec3> result;
    for (Index i = 0; i < pool.positions.size(); ++i) {
      result[pool.numbers.empty() ? i : pool.numbers[i]] = pool.positions[i];
    }
    EXPECT_EQ(result.size(), pool.positions.size());
    return result;
  };
  std::map<Index, Vec3> before = places();
  for (int tick = 0; tick < 150; ++tick) {
    ASSERT_TRUE(simulation.advance(10).events.empty());
    const std::map<Index, Vec3> now = places();
    const Diagnostics books = simulation.diagnostics();
    ASSERT_EQ(kStart + books.emitted_particles - books.drained_particles, pool_size(simulation));
    ASSERT_NEAR(books.bodies[0].mass, 0.125 * static_cast<Real>(pool_size(simulation)), 1e-9);
    const Index ever = static_cast<Index>(kStart + books.emitted_particles);
    ASSERT_TRUE(now.empty() || now.rbegin()->first < ever);
    for (const auto& [number, place] : now) {
      const auto known = before.find(number);
      if (known == before.end()) {
        ASSERT_TRUE(before.empty() || number > before.rbegin()->first) << tick;
        continue;
      }
      ASSERT_LT((place - known->second).norm(), 10 * kStep * 6) << "at most 6 m/s";
    }
    before = now;
  }
  EXPECT_FALSE(simulation.bodies()[0].numbers.empty());
  EXPECT_GT(simulation.diagnostics().drained_particles, 300U);
}

TEST(Flow, DrainsAWholeBody) {
  Scene scene = make_flow_scene();
  scene.emitters[0].from = 0.5;
  scene.drains = {make_floor_drain()};
  Simulation simulation = make_advanced(scene, 11);
  EXPECT_EQ(pool_size(simulation), 0U);
  EXPECT_EQ(simulation.diagnostics().bodies[0].mass, 0);
  EXPECT_FALSE(simulation.apply_force(simulation.bodies()[0].id, Vec3::UnitX(), 1).ok());
  EXPECT_TRUE(simulation.advance(500).events.empty());
  EXPECT_GT(pool_size(simulation), 0U);
}

TEST(Flow, KeepsTheOrderOfRemainingParticles) {
  Scene scene = make_flow_scene();
  scene.emitters.clear();
  scene.bodies.resize(1);
  // The lowest layer is drained.
  scene.bodies[0].shape = BoxShape{{0.5, 0.5, 0.2}, {0.2, 0.2, 0.2}};
  scene.drains = {{"slit", {0, 0, 0}, {1, 1, 0.15}}};
  Simulation simulation = make_simulation(scene);
  const std::vector<Vec3> start(simulation.bodies()[0].positions.begin(),
                                simulation.bodies()[0].positions.end());
  simulation.advance(1);
  const auto left = simulation.bodies()[0].positions;
  ASSERT_EQ(left.size(), 48U);
  for (std::size_t i = 0; i < left.size(); ++i) {
    EXPECT_LT((left[i] - start[16 + i]).norm(), 0.01) << i;
  }
}

TEST(Flow, EndsOnlyGrabsOfDrainedParticles) {
  Scene scene = make_flow_scene();
  scene.emitters.clear();
  scene.bodies[0].shape = BoxShape{{0.5, 0.5, 0.2}, {0.2, 0.2, 0.2}};
  scene.drains = {{"slit", {0, 0, 0}, {1, 1, 0.15}}};
  Simulation simulation = make_simulation(scene);
  const BodyId pool = simulation.bodies()[0].id;
  ASSERT_TRUE(simulation.grab_start(1, pool, 3, {0.5, 0.5, 0.2}).ok());
  ASSERT_TRUE(simulation.grab_start(2, pool, 63, {0.5, 0.5, 0.9}).ok());
  ASSERT_TRUE(simulation.grab_start(3, simulation.bodies()[1].id, 0, {0.9, 0.5, 0.2}).ok());
  EXPECT_EQ(simulation.advance(1).ended_grabs, std::vector<std::uint64_t>{1});
  EXPECT_FALSE(simulation.grab_end(1).ok());
  const Vec3 before =
      simulation.bodies()[0].positions.back();  // some of the earlier particles are gone
  simulation.advance(100);
  EXPECT_GT(simulation.bodies()[0].positions.back().z(), before.z() + 0.05);
  EXPECT_TRUE(simulation.grab_end(2).ok());
  EXPECT_TRUE(simulation.grab_end(3).ok());
}

TEST(Flow, HasTheSameBitsForAnyThreadsAndAfterARestore) {
  Scene scene = make_flow_scene();
  scene.drains = {make_floor_drain()};
  Simulation serial = make_simulation(scene);
  ThreadRunner threads(3);
  Simulation parallel = make_simulation(scene, &threads);
  serial.advance(333);
  for (int call = 0; call < 111; ++call) parallel.advance(3);
  EXPECT_EQ(parallel.state_hash(), serial.state_hash());
  const Snapshot snapshot = serial.snapshot();
  serial.advance(200);
  const std::uint64_t end = serial.state_hash();
  const Diagnostics books = serial.diagnostics();
  serial.restore(snapshot);
  serial.advance(200);
  EXPECT_EQ(serial.state_hash(), end);
  EXPECT_EQ(serial.diagnostics().emitted_particles, books.emitted_particles);
  EXPECT_EQ(serial.diagnostics().drained_particles, books.drained_particles);
}

TEST(Flow, InACallThatFailsIsUndone) {
  Simulation simulation = make_advanced(make_flow_scene(), 3);
  const BodyId ball = simulation.bodies()[1].id;
  // After about 100 steps the ball is too fast for the guard.
  ASSERT_TRUE(simulation.apply_force(ball, {0, 0, 1500}, 10).ok());
  const std::uint64_t hash = simulation.state_hash();
  const AdvanceReport report = simulation.advance(1000);
  ASSERT_TRUE(report.failed);
  ASSERT_GT(report.steps - report.undone_steps, 40U);  // at least one layer was emitted
  EXPECT_EQ(simulation.state_hash(), hash);
  EXPECT_EQ(simulation.diagnostics().emitted_particles, 9U * 4);
  EXPECT_EQ(pool_size(simulation), kStart + 9 * 4);
}

TEST(Flow, GoesWithItsBodyAndThatOfOthersContinues) {
  Scene scene = make_flow_scene();
  BodyDescription other = scene.bodies[0];
  other.name = "other";
  std::get<BoxShape>(other.shape).center = {0.2, 0.2, 0.03};
  scene.bodies.push_back(other);
  scene.emitters.push_back(scene.emitters[0]);
  scene.emitters[1].name = "second";
  scene.emitters[1].body = "other";
  scene.emitters[1].position = {0.2, 0.2, 0.8};
  Simulation simulation = make_advanced(scene, 100);
  ASSERT_TRUE(simulation.remove_body(simulation.bodies()[0].id).ok());
  ASSERT_EQ(simulation.scene().emitters.size(), 1U);
  EXPECT_EQ(simulation.scene().emitters[0].name, "second");
  for (int call = 0; call < 3; ++call) {
    ASSERT_TRUE(simulation.advance(100).events.empty());
    const std::span<const Vec3> velocities = simulation.bodies()[1].velocities;
    // Three layers are in the tube. At most one more was released in the last step.
    EXPECT_LE(std::ranges::count(velocities, Vec3(kSpeed, 0, 0)), 9 * 4);
    EXPECT_GE(std::ranges::count(velocities, Vec3(kSpeed, 0, 0)), 9 * 2);
  }
}

TEST(Flow, LeavesNoRoomForBodiesBeyondTheLimit) {
  Scene scene = make_flow_scene();
  scene.emitters[0].most_particles = kMaxParticles - 27 - 10;
  Simulation simulation = make_simulation(scene);
  BodyDescription more = scene.bodies[1];
  more.name = "more";
  more.position = {0.5, 0.5, 0.8};
  EXPECT_EQ(errors_of(simulation.add_body(more)), "too_many /body");
  scene.emitters[0].most_particles = kMaxParticles - 26;
  EXPECT_EQ(errors_of(find_errors(scene)), "too_many /emitters");
}

TEST(Nozzle, HasALatticeAcrossTheStream) {
  Scene scene = make_flow_scene();
  Emitter& emitter = scene.emitters[0];
  const auto layer_along = [&](const Vec3& direction) {
    emitter.direction = direction;
    return layer_of(emitter, kSpacing, 3);
  };
  emitter.size = {{4 * kSpacing, 2 * kSpacing}};
  for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, 0, -1), Vec3(1, 2, -3)}) {
    const std::vector<Vec3> layer = layer_along(direction);
    ASSERT_EQ(layer.size(), 8U);
    Vec3 sum = Vec3::Zero();
    for (const Vec3& place : layer) {
      EXPECT_NEAR((place - emitter.position).dot(direction), 0, 1e-15);
      sum += place;
    }
    EXPECT_LT((sum / 8 - emitter.position).norm(), 1e-15);
    // The long edge is horizontal.
    EXPECT_NEAR(layer[3].z(), layer[0].z(), 1e-15);
    EXPECT_NEAR((layer[3] - layer[0]).norm(), 3 * kSpacing, 1e-15);
  }
  emitter.size.reset();
  emitter.radius = 10 * kSpacing;
  const auto points = static_cast<Real>(layer_along({0, 0, -1}).size());
  EXPECT_NEAR(points / (100 * std::numbers::pi), 1, 0.05);
  emitter.direction = {1, 0, 1};
  const std::vector<Vec3> line = layer_of(emitter, kSpacing, 2);
  ASSERT_EQ(line.size(), 20U);
  for (const Vec3& place : line) EXPECT_EQ(place.y(), emitter.position.y());
}

// Dampers that need implicit steps are still solved implicitly.
TEST(Flow, TheLastLiquidMayLeaveAnIncompressibleScene) {
  Scene scene = make_flow_scene(IntegratorId::symplectic_euler);
  scene.pressure_solver = PressureSolver::incompressible;
  scene.emitters.clear();
  scene.drains = {make_floor_drain()};
  scene.bodies[1] = make_body("gel", BodyKind::deformable, "wood",
                              make_particles({{0.9, 0.5, 0.3}, {0.95, 0.5, 0.3}}, 0.05), 0.02);
  scene.bodies[1].springs = {{0, 1, {10, 1000}, 0.06}};
  Simulation simulation = make_simulation(scene);
  EXPECT_TRUE(simulation.advance(30).events.empty());
  EXPECT_EQ(pool_size(simulation), 0U);
  const BodyView gel = simulation.bodies()[1];
  EXPECT_LT((gel.velocities[1] - gel.velocities[0]).norm(), 0.01);
}

}  // namespace
}  // namespace vat::test::flow_test
