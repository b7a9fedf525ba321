#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "tests/core/support/resting_scenes.h"
#include "tests/physics/device/heap.h"
#include "tests/physics/device/on_device.h"

// Sleeping bodies on an OpenCL device.

namespace vat::device_sleep_test {
namespace {

using namespace test;

constexpr Real kDuration = 2.6;  ///< [s]

/// Returns for each body whether it sleeps.
std::vector<bool> sleepers_of(const Simulation& simulation) {
  std::vector<bool> sleepers;
  for (const BodyView& body : simulation.bodies()) sleepers.push_back(body.is_asleep);
  return sleepers;
}

/// Contacts with springs, which damp motion.
void use_penalties(Scene& scene) {
  scene.default_interface = {20000, 200, 0.3};
  scene.sleeping = Sleeping{0.02, 0.1};
  scene.bodies[1].position.z() = 12;  // the others sleep before the marble arrives
  scene.numerics.step = 1.0 / 960;
  scene.numerics.tick = 16 * scene.numerics.step;
}

/// Adds a deformable block that comes to rest far from the other bodies, and one above it.
void add_blocks(Scene& scene) {
  use_penalties(scene);
  scene.materials.push_back(make_material("jelly", 400));
  scene.materials[1].springs =
      LatticeSprings{SpringConstants{600, 8}, SpringConstants{300, 4}, SpringConstants{150, 2}};
  for (const Real height : {0.12, 4.0}) {
    BodyDescription block{"block " + std::to_string(scene.bodies.size()), BodyKind::deformable,
                          "jelly", BoxShape{Vec3::Zero(), {0.3, 0.3, 0.2}}, 0.1};
    block.position = {-5, 0, height};
    scene.bodies.push_back(std::move(block));
  }
}

struct SleepCase {
  const char* name;
  std::function<void(Scene&)> edit;
};

const SleepCase kCases[] = {
    {"projection", [](Scene&) {}},
    {"penalty", use_penalties},
    {"deformable bodies", add_blocks},
    {"a fixed body that carries others",
     [](Scene& scene) {
       scene.bodies.push_back(make_crate("rock", {5, 0, 0.15}));
       scene.bodies.back().fixed = true;
       scene.bodies[3].position.z() = kCrateRest + kCrateEdge;
     }},
    {"a held body that falls",
     [](Scene& scene) {
       scene.bodies.push_back(make_crate("held", {5.05, 0, 1}));
       scene.bodies.back().release = 1;
     }},
    {"periodic axes",
     [](Scene& scene) {
       use_penalties(scene);
       scene.vat->min.x() = -0.2;
       scene.vat->max.x() = 9;
       scene.periodic = Periodicity{{-0.2, 0, 0}, {9, 0, 0}, {true, false, false}};
       scene.bodies[1].position.x() += 9.2;
     }},
    {"symplectic Euler",
     [](Scene& scene) { scene.numerics.integrator = IntegratorId::symplectic_euler; }},
};

/// Returns the difference of positions after `steps` steps, if each step changes the velocities of
/// contacts by 1e-8 of their distance per step, the tolerance of their solve [m].
Real tolerance_of_projection(std::uint32_t steps) {
  const auto n = static_cast<Real>(steps);
  return n * n / 2 * 1e-8 * 2 * kRestRadius;
}

/// Expects that the same bodies sleep as on the CPU after each tick, and that bodies both fall
/// asleep and wake. The device takes all steps in which a body is awake, except for those in which
/// only the CPU solves for contacts by projection.
void expect_sleep_of_cpu(const Scene& scene, std::uint32_t ticks_per_call) {
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  const std::uint32_t steps = ticks_per_call * cpu.steps_per_tick();
  const bool is_projected = scene.default_interface.law == InterfaceLaw::projection;
  std::uint64_t all_steps = 0;
  std::uint64_t device_steps = 0;
  int slept = 0;
  int woke = 0;
  std::vector<bool> before = sleepers_of(cpu);
  while (cpu.time() < kDuration) {
    const AdvanceReport expected = cpu.advance(steps);
    const AdvanceReport report = device.advance(steps);
    ASSERT_EQ(expected.undone_steps, 0U);
    ASSERT_EQ(report.steps, expected.steps) << cpu.time();
    if (!is_projected) ASSERT_EQ(report.device_steps, expected.steps) << cpu.time();
    all_steps += expected.steps;
    device_steps += report.device_steps;
    const std::vector<bool> sleepers = sleepers_of(cpu);
    ASSERT_EQ(sleepers_of(device), sleepers) << cpu.time();
    for (std::size_t b = 0; b < sleepers.size(); ++b) {
      slept += sleepers[b] && !before[b] ? 1 : 0;
      woke += !sleepers[b] && before[b] ? 1 : 0;
    }
    before = sleepers;
  }
  EXPECT_GE(slept, 3);
  EXPECT_GE(woke, 2);
  EXPECT_GE(device_steps, all_steps * 9 / 10);
  const auto total = static_cast<std::uint32_t>(kDuration / scene.numerics.step);
  EXPECT_LT(difference(device, cpu),
            is_projected ? tolerance_of_projection(total) : rounding_after(total));
  EXPECT_EQ(device.sleeping_body_count(), cpu.sleeping_body_count());
}

TEST(SleepOnDevice, IsThatOfTheCpu) {
  for (const SleepCase& one : kCases) {
    SCOPED_TRACE(one.name);
    Scene scene = make_struck_stack();
    one.edit(scene);
    expect_sleep_of_cpu(scene, 1);
  }
}

TEST(SleepOnDevice, DependsNotOnTheCallsOfTheSteps) {
  Scene scene = make_struck_stack();
  add_blocks(scene);
  expect_sleep_of_cpu(scene, 7);
}

TEST(SleepOnDevice, OfAllBodiesTakesNoSteps) {
  Scene scene = make_resting_scene();
  scene.bodies = {make_crate("one", 0.0), make_crate("two", 5.0)};
  Simulation device = make_on_device(scene);
  EXPECT_EQ(device.advance(120).device_error, std::nullopt);
  ASSERT_EQ(device.sleeping_body_count(), 2U);
  const AdvanceReport report = device.advance(100);
  EXPECT_EQ(report.steps, 0U);
  EXPECT_EQ(report.device_error, std::nullopt);
  EXPECT_DOUBLE_EQ(device.time(), 220 * device.step_size());
}

TEST(SleepOnDevice, HasTheSameBitsInAnyPortionsOfSteps) {
  Scene scene = make_struck_stack();
  add_blocks(scene);
  Simulation simulation = make_on_device(scene);
  simulation.advance(400);
  ASSERT_GT(simulation.sleeping_body_count(), 0U);
  expect_same_bits_in_any_portions(scene, 40);
}

TEST(SleepOnDevice, EndsByACommand) {
  Scene scene = make_resting_scene();
  scene.bodies = {make_crate("one", 0.0), make_crate("two", 5.0)};
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  for (Simulation* each : {&device, &cpu}) {
    each->advance(120);
    ASSERT_EQ(each->sleeping_body_count(), 2U);
    ASSERT_TRUE(each->set_gravity({0, 0, 1}).ok());
  }
  EXPECT_EQ(device.advance(30).device_steps, 30U);
  cpu.advance(30);
  EXPECT_EQ(device.sleeping_body_count(), 0U);
  EXPECT_LT(difference(device, cpu), tolerance_of_projection(150));
}

TEST(SleepOnDevice, ContinuesSleepOfTheCpu) {
  Simulation cpu = make_advanced(make_struck_stack(), 200);
  ASSERT_EQ(cpu.sleeping_body_count(), 3U);
  Simulation device = Simulation::from(cpu.snapshot());
  ASSERT_TRUE(device.set_engine(make_device()).ok());
  EXPECT_EQ(device.advance(40).device_steps, 40U);
  device.advance(40);
  cpu.advance(80);
  EXPECT_EQ(sleepers_of(device), sleepers_of(cpu));
  EXPECT_EQ(device.sleeping_body_count(), 1U);
  EXPECT_LT(difference(device, cpu), tolerance_of_projection(80));
}

// The greatest displacement of a step depends on all bodies. The marble is awake, and the crate
// sleeps.
TEST(SleepOnDevice, HasTheGuardOfAllBodies) {
  Scene scene = make_resting_scene();
  scene.gravity.setZero();
  scene.vat.reset();
  scene.bodies = {make_crate("crate", {0, 0, 0}), make_marble("marble", {100, 0, 0})};
  scene.bodies[1].velocity = {-30, 0, 0};  // 0.125 m per step; the reach is 0.1 m
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  for (Simulation* each : {&device, &cpu}) {
    each->advance(120);
    ASSERT_EQ(each->sleeping_body_count(), 1U);
    EXPECT_EQ(each->advance(20).undone_steps, 20U);
  }
}

}  // namespace
}  // namespace vat::device_sleep_test
