#include <gtest/gtest.h>

#include <utility>

#include "core/device/device_engine.h"
#include "tests/physics/device/heap.h"
#include "tests/physics/device/on_device.h"
#include "tests/support/scenes.h"

// Sums over pairs in vectors, on OpenCL devices that are CPUs.

namespace vat::device_lanes_test {
namespace {

using namespace test;

constexpr Real kSpacing = 0.02;

/// A column of a viscous liquid that moves towards a wall, and is narrower than its vat.
Scene make_column(PressureSolver solver) {
  const bool is_tait = solver == PressureSolver::tait;
  Scene scene =
      make_scene(is_tait ? IntegratorId::velocity_verlet : IntegratorId::symplectic_euler, 1e-3);
  scene.pressure_solver = solver;
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_liquid("water", 1000, {is_tait ? 400.0 : 0.0, 0.1, 2 * kSpacing})};
  scene.vat = Vat{{0, 0, 0}, {0.3, 0.12, 0.4}, false, {}};
  scene.bodies = {BodyDescription{"column", BodyKind::liquid, "water",
                                  BoxShape{{0.08, 0.06, 0.12}, {0.16, 0.12, 0.24}}, kSpacing}};
  scene.bodies[0].velocity = {0.5, 0, 0};
  return scene;
}

const SceneCase kScenes[] = {
    {"no-slip walls that move", set_no_slip},
    {"particles of two weights",
     [](Scene& scene) {
       scene.bodies.push_back(scene.bodies[0]);
       scene.bodies[1].name = "drop";
       scene.bodies[1].spacing = 0.9 * kSpacing;
       scene.bodies[1].shape = SphereShape{{0.22, 0.06, 0.1}, 0.05};
     }},
    {"some particles with more neighbours than a list has",
     [](Scene& scene) { scene.materials[0].liquid->support_radius = 4.2 * kSpacing; }},
    {"lists of more than 64 neighbours",
     [](Scene& scene) { scene.materials[0].liquid->support_radius = 2.6 * kSpacing; }},
    {"large cells, because the vat is large",
     [](Scene& scene) {
       scene.vat->max = {3, 3, 0.4};
       scene.bodies[0].shape = BoxShape{{0.3, 0.3, 0.04}, {0.6, 0.6, 0.08}};
     }},
    {"periodic world between two walls",
     [](Scene& scene) {
       scene.periodic = Periodicity{{0, 0, 0}, {0.16, 0.12, 0.3}, {true, true, false}};
       scene.vat->max = {0.16, 0.12, 0.3};
     }},
    {"adaptive steps", [](Scene& scene) { scene.numerics.control = StepControl::adaptive; }},
};

/// Returns the hash after some steps on a device with this number of lanes.
std::uint64_t hash_with_lanes(const Scene& scene, std::uint32_t lanes) {
  constexpr std::uint32_t kSteps = 5;
  opencl::Device device = opencl::find_device(0).value();
  EXPECT_EQ(device.lanes, opencl::kMostLanes) << "a CPU";
  device.lanes = lanes;
  Result<std::unique_ptr<StepEngine>> engine = make_device_engine(device, DeviceArithmetic::exact);
  Simulation simulation = make_simulation(scene);
  EXPECT_TRUE(simulation.set_engine(std::move(engine).value()).ok());
  EXPECT_EQ(simulation.advance(kSteps).device_steps, kSteps);
  return simulation.state_hash();
}

// Vectors do not change the operations of a particle and their order.
TEST(LanesOfDevices, DoNotChangeTheBits) {
  for (const PressureSolver solver : {PressureSolver::tait, PressureSolver::incompressible}) {
    for (const std::span<const SceneCase> cases :
         {std::span<const SceneCase>(kCommonScenes), std::span<const SceneCase>(kScenes)}) {
      for (const SceneCase& one : cases) {
        SCOPED_TRACE(testing::Message() << one.name << ", solver " << static_cast<int>(solver));
        Scene scene = make_column(solver);
        one.edit(scene);
        EXPECT_EQ(hash_with_lanes(scene, opencl::kMostLanes), hash_with_lanes(scene, 1));
      }
    }
  }
}

// The steps do not resolve the viscosity.
TEST(LanesOfDevices, DoNotChangeTheBitsOfSolvesForViscosity) {
  Scene scene = make_column(PressureSolver::tait);
  scene.materials[0].liquid->viscosity = 20;
  set_no_slip(scene);
  add_fixed_bodies(scene);
  EXPECT_EQ(hash_with_lanes(scene, opencl::kMostLanes), hash_with_lanes(scene, 1));
}

/// Adds a ball and a jelly that fall on each other and on the liquid, with a long step.
void add_bodies(Scene& scene) {
  scene.materials.push_back(make_material("wood", 500));
  scene.materials.push_back(make_material("jelly", 400));
  scene.materials[2].springs =
      LatticeSprings{SpringConstants{600, 20}, SpringConstants{300, 10}, SpringConstants{150, 5}};
  scene.default_interface = {1000, 20};
  scene.default_interface.friction = 0.4;
  scene.bodies.push_back(BodyDescription{"ball", BodyKind::rigid, "wood",
                                         SphereShape{{0.22, 0.06, 0.03}, 0.03}, kSpacing});
  scene.bodies.push_back(BodyDescription{"jelly", BodyKind::deformable, "jelly",
                                         BoxShape{{0.22, 0.06, 0.08}, {0.08, 0.06, 0.04}},
                                         kSpacing});
  scene.bodies[1].angular_velocity = {5, 20, 0};
  scene.bodies[2].velocity = {0, 0, -1};
}

// A tree of the sums of a group has the same order.
TEST(LanesOfDevices, DoNotChangeTheBitsOfBodies) {
  Scene scene = make_column(PressureSolver::tait);
  scene.materials[0].liquid->viscosity = 0.01;
  add_bodies(scene);
  const std::uint64_t in_liquid = hash_with_lanes(scene, opencl::kMostLanes);
  EXPECT_EQ(in_liquid, hash_with_lanes(scene, 1));
  scene.bodies.erase(scene.bodies.begin());
  const std::uint64_t alone = hash_with_lanes(scene, opencl::kMostLanes);
  EXPECT_EQ(alone, hash_with_lanes(scene, 1));
  EXPECT_NE(alone, in_liquid);
}

TEST(LanesOfDevices, DoNotChangeTheBitsOfRigidBodies) {
  Scene scene = make_heap();
  add_small_bodies(scene);
  EXPECT_EQ(hash_with_lanes(scene, opencl::kMostLanes), hash_with_lanes(scene, 1));
}

TEST(LanesOfDevices, DoNotChangeTheBitsOfBodiesInIncompressibleLiquids) {
  for (const Real support : {2 * kSpacing, 4.2 * kSpacing}) {  // complete and incomplete lists
    Scene scene = make_column(PressureSolver::incompressible);
    scene.materials[0].liquid->support_radius = support;
    add_bodies(scene);
    scene.materials[2].springs =
        LatticeSprings{SpringConstants{200, 0}, SpringConstants{100, 0}, SpringConstants{50, 0}};
    scene.default_interface.damping = 0.2;
    EXPECT_EQ(hash_with_lanes(scene, opencl::kMostLanes), hash_with_lanes(scene, 1));
  }
}

TEST(LanesOfDevices, DoNotChangeTheBitsOfAdaptiveStepsOfBodies) {
  Scene scene = make_column(PressureSolver::incompressible);
  add_bodies(scene);
  scene.bodies.pop_back();
  scene.bodies[1].position = {-0.03, 0, 0};
  scene.numerics.control = StepControl::adaptive;
  EXPECT_EQ(hash_with_lanes(scene, opencl::kMostLanes), hash_with_lanes(scene, 1));
}

}  // namespace
}  // namespace vat::device_lanes_test
