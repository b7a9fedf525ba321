#include <gtest/gtest.h>

#include <initializer_list>
#include <utility>

#include "tests/physics/device/on_device.h"
#include "tests/support/scenes.h"

// Periodic worlds on an OpenCL device.

namespace vat::device_periodic_test {
namespace {

using namespace test;

constexpr Real kSpacing = 0.02;

/// A box of water that flows through the sides of a periodic world, above a floor.
Scene make_flow() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.pressure_solver = PressureSolver::tait;
  scene.gravity = {3, 0, -9.81};
  scene.materials = {make_liquid("water", 1000, {400, 0.01, 2 * kSpacing})};
  scene.materials[0].liquid->artificial_viscosity = 0.1;
  scene.periodic = Periodicity{{0.011, 0, 0}, {0.211, 0.12, 0}, {true, true, false}};
  scene.vat = Vat{{0.011, 0, 0}, {0.211, 0.12, 0.4}, false, {}};
  scene.bodies = {BodyDescription{"box", BodyKind::liquid, "water",
                                  BoxShape{{0.111, 0.06, 0.06}, {0.2, 0.12, 0.12}}, kSpacing}};
  scene.bodies[0].velocity = {3, -2, 0.5};
  return scene;
}

/// A drop that is torn by the sides of a world without walls.
void set_drop(Scene& scene) {
  scene.vat.reset();
  scene.gravity.setZero();
  scene.periodic = Periodicity{{-0.13, -0.13, -0.13}, {0.13, 0.13, 0.13}, {true, true, true}};
  scene.bodies[0].shape = SphereShape{{0.12, 0.12, -0.12}, 0.06};
  scene.bodies[0].velocity = {1, 0.5, -0.7};
  scene.bodies[0].jitter = 0.2;
}

void set_plane(Scene& scene) {
  set_plane_of_liquid(scene);
  scene.periodic->axes[1] = false;
  scene.bodies[0].velocity.y() = 0;
}

void make_solids_of(Scene& scene, std::initializer_list<BodyKind> kinds) {
  Material wood = make_material("wood", 500);
  wood.springs = LatticeSprings{SpringConstants{200, 0.05}, SpringConstants{100, 0.02},
                                SpringConstants{50, 0}};
  scene.materials.push_back(wood);
  scene.default_interface = {1000, 0.2};
  // The bodies are beside opposite sides of the world. They approach each other through these
  // sides.
  Real x = 0.18;
  for (const BodyKind kind : kinds) {
    const bool is_first = x > 0.1;
    BodyDescription body{is_first ? "solid" : "other", kind, "wood",
                         BoxShape{Vec3::Zero(), {0.06, 0.06, 0.06}}, kSpacing};
    body.position = {x, 0.06, 0.165};
    body.velocity = {is_first ? 2.5 : 0.5, 1, -1};
    scene.bodies.push_back(std::move(body));
    x = 0.055;
  }
}

const SceneCase kLiquidScenes[] = {
    {"floor and two periodic axes", [](Scene&) {}},
    {"drop in a corner of the world", set_drop},
    {"two dimensions", set_plane},
    {"fixed ball on a side",
     [](Scene& scene) {
       scene.materials.push_back(make_material("stone", 2000));
       scene.bodies.push_back(make_fixed("ball", SphereShape{{0.211, 0.06, 0.15}, 0.04}, kSpacing));
     }},
};

TEST(PeriodicDevice, HasTheAccuracyOfTheCpuWithTait) {
  expect_accuracy_of_cpu(make_flow(), kLiquidScenes, 60);
  const SceneCase scenes[] = {
      {"channel between no-slip walls",
       [](Scene& scene) {
         scene.vat->lid = true;
         scene.vat->max.z() = 0.16;
         for (const std::size_t wall : {4U, 5U}) scene.vat->walls[wall].no_slip = true;
       }},
      {"rigid bodies",
       [](Scene& scene) {
         make_solids_of(scene, {BodyKind::rigid, BodyKind::rigid});
       }},
      {"deformable bodies",
       [](Scene& scene) {
         make_solids_of(scene, {BodyKind::deformable, BodyKind::deformable});
         scene.numerics.step = scene.numerics.tick = 2.5e-4;  // resolves the damping of the springs
       }},
  };
  expect_accuracy_of_cpu(make_flow(), scenes, 60);
}

TEST(PeriodicDevice, HasTheAccuracyOfTheCpuWithSurfaceTension) {
  Scene scene = make_flow();
  set_drop(scene);
  scene.numerics.step = scene.numerics.tick = 2e-3;
  scene.materials[0].liquid = LiquidConstants{4, 0.1, 3 * kSpacing};
  scene.materials[0].liquid->surface_tension = 0.5;
  const SceneCase scenes[] = {
      {"curvature", [](Scene&) {}},
      {"cohesion", [](Scene& s) { s.surface_model = SurfaceModel::cohesion; }},
  };
  expect_accuracy_of_cpu(scene, scenes, 60, 5);
}

TEST(PeriodicDevice, HasTheAccuracyOfTheCpuWithAnIncompressibleLiquid) {
  Scene scene = make_flow();
  scene.pressure_solver = PressureSolver::incompressible;
  scene.incompressible.divergence_tolerance = 1e-7;
  scene.numerics.integrator = IntegratorId::symplectic_euler;
  scene.numerics.step = scene.numerics.tick = 2e-3;
  scene.materials[0].liquid->artificial_viscosity = 0;
  expect_accuracy_of_cpu(scene, kLiquidScenes, 15, 4);
}

/// The flow with the solver `gas`, whose particles collide with walls and solids.
Scene make_gas() {
  Scene scene = make_flow();
  scene.pressure_solver = PressureSolver::gas;
  scene.materials = {make_liquid("water", 1000, {20, 2, 2 * kSpacing})};
  scene.numerics.step = scene.numerics.tick = 5e-4;
  scene.default_interface = {20'000, 2};
  return scene;
}

TEST(PeriodicDevice, HasTheMotionOfTheCpuWithGas) {
  const SceneCase scenes[] = {
      {"floor and two periodic axes", [](Scene&) {}},
      {"drop in a corner of the world", set_drop},
      {"two dimensions", set_plane},
      {"solids",
       [](Scene& scene) {
         make_solids_of(scene, {BodyKind::rigid, BodyKind::deformable});
       }},
  };
  for (const SceneCase& one : scenes) {
    SCOPED_TRACE(one.name);
    Scene scene = make_gas();
    one.edit(scene);
    expect_motion_of_cpu(scene, 120);
  }
}

/// Bodies that collide through a side of a world without liquids.
Scene make_bodies(std::initializer_list<BodyKind> kinds) {
  Scene scene = make_flow();
  make_solids_of(scene, kinds);
  scene.bodies.erase(scene.bodies.begin());
  return scene;
}

TEST(PeriodicDevice, HasTheMotionOfTheCpuWithSolids) {
  for (const BodyKind kind : {BodyKind::rigid, BodyKind::deformable}) {
    SCOPED_TRACE(static_cast<int>(kind));
    Scene scene = make_bodies({kind, kind});
    scene.default_interface.friction = 0.3;
    expect_motion_of_cpu(scene, 120);
    scene.gravity.setZero();
    scene.vat.reset();
    expect_motion_of_cpu(scene, 120);
  }
}

}  // namespace
}  // namespace vat::device_periodic_test
