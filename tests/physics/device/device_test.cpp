#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/device/common/arithmetic_check.h"
#include "protocol/scene/scene_json.h"
#include "tests/physics/device/column.h"
#include "tests/support/scenes.h"

// Weakly compressible liquids on an OpenCL device.

namespace vat::device_test {
namespace {

using namespace test;

/// A column of honey that flows on fixed bodies between no-slip walls. Its steps do not resolve its
/// viscosity.
Scene make_honey() {
  Scene scene = make_column();
  scene.materials[0].liquid->viscosity = 20;
  scene.materials[0].liquid->artificial_viscosity = 0;
  set_no_slip(scene);
  add_fixed_bodies(scene);
  scene.bodies[0].velocity = {1, 0, 0};
  return scene;
}

/// Fills the vat with liquid that flows along its lid.
void fill_vat(Scene& scene) {
  scene.vat->lid = true;
  scene.vat->max = {0.16, 0.12, 0.24};
  for (Wall& wall : scene.vat->walls) wall.no_slip = true;
  scene.vat->walls[5].velocity = {2, 0, 0};
  scene.bodies[0].jitter = 0.1;
  scene.materials[0].liquid->viscosity = 0.3;
  scene.numerics.step = scene.numerics.tick = 5e-4;
}

const SceneCase kScenes[] = {
    {"vat full of liquid", fill_vat},
    {"vat full of liquid around a ball",
     [](Scene& scene) {
       fill_vat(scene);
       scene.materials.push_back(make_material("stone", 2000));
       scene.bodies.push_back(
           make_fixed("ball", SphereShape{{0.08, 0.06, 0.12}, 0.03}, kColumnSpacing));
     }},
    {"periodic world full of liquid",
     [](Scene& scene) {
       scene.vat.reset();
       scene.periodic = Periodicity{{0, 0, 0}, {0.16, 0.12, 0.24}, {true, true, true}};
       scene.bodies[0].jitter = 0.2;
       scene.gravity = {1, 0, 0};
     }},
    {"no-slip walls that move",
     [](Scene& scene) {
       scene.vat->motion = SlideMotion{Vec3(0, 1, 0), 0.02, 3};
       set_no_slip(scene);
     }},
    {"honey between slip walls",
     [](Scene& scene) {
       scene.materials[0].liquid->viscosity = 0.3;
       scene.materials[0].liquid->artificial_viscosity = 0;
       scene.numerics.step = scene.numerics.tick = 5e-4;
     }},
    {"without a vat", [](Scene& scene) { scene.vat.reset(); }},
    {"central field",
     [](Scene& scene) {
       scene.vat.reset();
       scene.gravity = {0, 0, -1};
       scene.central_field = CentralField{{0.1, 0.05, 0.2}, 12};
     }},
    {"without gravity",
     [](Scene& scene) {
       scene.forces.gravity = false;
       scene.bodies[0].velocity = {0.5, 0, 0.2};
     }},
};

// Both compute sums over pairs in single precision. Differences from double precision are therefore
// of equal size, up to the order of sums.
TEST(Device, HasTheAccuracyOfTheCpu) {
  constexpr std::uint32_t kSteps = 30;
  expect_accuracy_of_cpu(make_column(), kCommonScenes, kSteps);
  expect_accuracy_of_cpu(make_column(), kScenes, kSteps);
}

TEST(Device, HasTheAccuracyOfTheCpuWithTheCubicSpline) {
  Scene scene = make_column();
  scene.kernel = KernelId::cubic_spline;
  expect_accuracy_of_cpu(scene, kScenes, 30);
}

// The device compiles its kernels for the scene.
TEST(Device, ChangesTheKernel) {
  Simulation simulation = make_on_device(make_column());
  simulation.advance(10);
  Scene scene = make_column();
  scene.kernel = KernelId::cubic_spline;
  Simulation other = make_on_device(scene);
  EXPECT_EQ(other.advance(10).device_steps, 10U);
  EXPECT_GT(difference(simulation, other), 1e-6);
}

TEST(Device, HasTheAccuracyOfTheCpuWithOtherIntegrators) {
  constexpr std::uint32_t kSteps = 15;  // explicit Euler is unstable
  expect_accuracy_with_other_integrators(make_column(), kScenes, kSteps);
}

// The solves of the device and of the CPU meet the same tolerance.
TEST(Device, SolvesForStrongViscosity) {
  constexpr std::uint32_t kSteps = 30;
  const SceneCase cases[] = {
      {"fixed steps", [](Scene&) {}},
      {"settling in a sliding vat",
       [](Scene& scene) {
         scene.settling = Settling{200, 1};
         scene.vat->motion = SlideMotion{{1, 0, 0}, 0.1, 0.2};
       }},
      {"slip walls",
       [](Scene& scene) {
         for (Wall& wall : scene.vat->walls) wall = {};
       }},
      {"without a vat", [](Scene& scene) { scene.vat.reset(); }},
      {"adaptive steps", [](Scene& scene) { scene.numerics.control = StepControl::adaptive; }},
  };
  for (const SceneCase& one : cases) {
    SCOPED_TRACE(one.name);
    Scene scene = make_honey();
    one.edit(scene);
    expect_damping_of_cpu(scene, kSteps, kSteps + 1);
  }
}

TEST(Device, ReflectsParticlesAtWalls) {
  Scene scene = make_column();
  // The particles are beyond a wall after one step.
  const std::vector<Vec3> positions = {{0.001, 0.06, 0.2}, {0.299, 0.06, 0.1}, {0.1, 0.001, 0.001}};
  scene.gravity = Vec3::Zero();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    ParticleShape shape = make_particles({positions[i]}, 8e-3);
    scene.bodies.push_back(
        make_body("particle " + std::to_string(i), BodyKind::liquid, "water", shape, 0.01));
  }
  scene.bodies.erase(scene.bodies.begin());
  scene.bodies[0].velocity = {-3, 1, 0};
  scene.bodies[1].velocity = {3, 0, 1};
  scene.bodies[2].velocity = {0, -3, -4};
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  EXPECT_EQ(device.advance(1).wall_stops, 3U);
  EXPECT_EQ(cpu.advance(1).wall_stops, 3U);
  // An error of the relative density of one rounding unit accelerates by its pressure times the
  // slope of the kernel, which is at most 20 / h.
  const Real dt = scene.numerics.step;
  const Real error = 400 * std::ldexp(1.0, -23) * 20 / (2 * kColumnSpacing);
  for (std::size_t body = 0; body < positions.size(); ++body) {
    EXPECT_LT((position_of(device, body) - position_of(cpu, body)).norm(), error * dt * dt);
    EXPECT_LT((velocity_of(device, body) - velocity_of(cpu, body)).norm(), error * dt);
  }
}

TEST(Device, HasTheSameBitsInAnyPortionsOfSteps) {
  expect_same_bits_in_any_portions(make_column(), 4);
  expect_same_bits_in_any_portions(make_honey(), 4);
  Scene full = make_column();
  fill_vat(full);
  expect_same_bits_in_any_portions(full, 4);
}

TEST(Device, ContinuesAStateOfTheCpuAndTheReverse) {
  expect_continuation(make_column(), 20, 1e-4 * kColumnSpacing);
}

// Each operation is rounded as IEEE 754 defines it, so that the hash is a constant. An NVIDIA H200
// has the same hash.
TEST(Device, HasTheSameBitsOnEveryDeviceIfExact) {
  const Result<Scene> scene = read_scene_file(VAT_SOURCE_DIR "/protocol/scenes/dam-break.json");
  ASSERT_TRUE(scene.ok());
  Simulation simulation = make_on_device(scene.value());
  EXPECT_EQ(simulation.arithmetic(), "opencl-exact");
  EXPECT_EQ(simulation.advance(120).device_steps, 120U);
  EXPECT_EQ(simulation.state_hash(), 0x5d678a6cc5234a07U);
}

TEST(Device, LeavesForcesOfUsersToTheCpu) {
  const Scene scene = make_column();
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  for (Simulation* one : {&device, &cpu}) {
    ASSERT_TRUE(one->grab_start(1, one->bodies()[0].id, 5, {0.1, 0.1, 0.4}).ok());
  }
  EXPECT_EQ(device.advance(5).device_steps, 0U);
  cpu.advance(5);
  EXPECT_EQ(device.state_hash(), cpu.state_hash());
  ASSERT_TRUE(device.grab_end(1).ok());
  EXPECT_EQ(device.advance(5).device_steps, 5U);
}

TEST(Device, LeavesAFailedStepToTheCpu) {
  struct Case {
    const char* name;
    std::uint32_t steps;
    std::function<void(Scene&)> edit;
  };
  // The greatest speed is half a support radius per step, 20 m/s.
  const Case cases[] = {
      {"too fast", 3,
       [](Scene& s) {
         s.bodies[0].velocity = {0, 0, 30};
       }},
      {"too fast after the last step", 1,
       [](Scene& s) {
         s.bodies[0].velocity = {0, 0, -19.995};
       }},
      {"too fast after a step but the last", 2,
       [](Scene& s) {
         s.bodies[0].velocity = {0, 0, 25};
         s.settling = Settling{200, 1};
       }},
      {"outside the domain", 1,
       [](Scene& s) {
         s.bodies[0].shape = SphereShape{{0.15, 0.06, 40.37}, 0.04};
         s.bodies[0].velocity = {0, 0, 19};
       }},
  };
  for (const Case& one : cases) {
    SCOPED_TRACE(one.name);
    Scene scene = make_column();
    one.edit(scene);
    expect_steps_of_cpu(scene, one.steps);
  }
}

TEST(Device, RestoresTheStateBeforeAFailedStep) {
  Scene scene = make_column();
  scene.bodies[0].position.z() = 3;
  scene.vat->max.z() = 8;
  scene.bodies[0].velocity = {0, 0, -19.985};
  expect_restored_state(scene, 1, 2);
}

TEST(Device, RefusesFeaturesThatItLacks) {
  const SceneCase cases[] = {
      {"/bodies/1/material",
       [](Scene& s) {
         s.numerics.control = StepControl::adaptive;
         s.materials.push_back(s.materials[0]);
         s.materials[1].name = "oil";
         s.bodies.push_back(s.bodies[0]);
         s.bodies[1].name = "film";
         s.bodies[1].material = "oil";
         s.bodies[1].shape = SphereShape{{0.25, 0.06, 0.3}, 0.03};
       }},
      {"/central_field",
       [](Scene& s) {
         s.central_field = CentralField{{0, 0, 0}, 1};
       }},
      {"/sleeping", [](Scene& s) { s.sleeping = Sleeping{}; }},
      {"/pair_precision",
       [](Scene& s) {
         s.pair_precision = PairPrecision::double_precision;
         s.numerics.control = StepControl::adaptive;
       }},
      {"/numerics/control",
       [](Scene& s) {
         s.numerics.integrator = IntegratorId::symplectic_euler;
         s.numerics.control = StepControl::adaptive;
       }},
      {"/numerics/control", [](Scene& s) { s.numerics.control = StepControl::local; }},
      {"/numerics/control",
       [](Scene& s) {
         fill_vat(s);
         s.numerics.control = StepControl::adaptive;
       }},
      {"/numerics/step",
       [](Scene& s) {
         s.materials[0].liquid->viscosity = 20;
         s.emitters.push_back(make_tap_into("column"));
       }},
  };
  expect_refusals(make_column(), cases);
}

TEST(Device, IsRefusedIfOtherScenesUseItsMemory) {
  const opencl::Device device = opencl::find_device(0).value();
  const std::uint64_t used = *device.used_memory;
  {
    Simulation simulation = Simulation::create(make_column()).value();
    ASSERT_TRUE(use_device(parse_device("opencl").value(), simulation));
    const std::uint64_t more = *device.used_memory - used;
    EXPECT_GT(more, 300 * simulation.particle_count());  // see the table of DEVICE.md
    const std::uint64_t free = device.memory - *device.used_memory;
    *device.used_memory += free - more / 2;
    Simulation other = Simulation::create(make_column()).value();
    const Status status = use_device(parse_device("opencl").value(), other);
    *device.used_memory -= free - more / 2;
    ASSERT_FALSE(status);
    EXPECT_EQ(status.errors()[0].code, "device_failed");
    EXPECT_THAT(status.errors()[0].message, testing::HasSubstr("are in use"));
    EXPECT_TRUE(use_device(parse_device("opencl").value(), other));
  }
  EXPECT_EQ(*device.used_memory, used);
}

// Each operation has 256 results.
TEST(Device, IsRefusedIfItRoundsIncorrectly) {
  const opencl::Device device{.name = "Pocket", .driver = "ACME 1"};
  const std::vector<double> exact = exact_arithmetic();
  EXPECT_TRUE(check_arithmetic(device, exact));
  const std::pair<std::size_t, const char*> cases[] = {
      {0, "a product and a sum in single precision"},
      {3 * 256, "a subnormal product"},
      {7 * 256 - 1, "a square root in double precision"}};
  for (const auto& [index, operation] : cases) {
    std::vector<double> wrong = exact;
    wrong[index] = std::nextafter(wrong[index], 10);
    const Status status = check_arithmetic(device, wrong);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.errors()[0].code, "not_available");
    EXPECT_THAT(
        status.errors()[0].message,
        testing::HasSubstr(std::string("Pocket (ACME 1) rounds ") + operation + " incorrectly"));
  }
}

TEST(Device, IsRefusedIfItDoesNotExist) {
  const auto engine = make_engine(parse_device("opencl:1000").value());
  ASSERT_FALSE(engine.ok());
  EXPECT_EQ(engine.errors().front().code, "not_available");
}

}  // namespace
}  // namespace vat::device_test
