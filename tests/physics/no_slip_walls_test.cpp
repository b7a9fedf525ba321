#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/kernels/smoothing_kernel.h"
#include "tests/support/same_bits.h"

// No-slip walls of the weakly compressible liquid in long steps; LIQ-7-tait and LIQ-19 have theory.

namespace vat::no_slip_walls_test {
namespace {

using namespace test;

constexpr Real kSupport = 3.5;         // [spacings]
constexpr Real kViscosity = 1e-6;      // kinematic [m^2/s]
constexpr Real kWidth = 1e-3;          // between the plates [m]
constexpr Real kPlateSpeed = 1.25e-5;  // [m/s]
constexpr Real kAcceleration = 1e-4;   // [m/s^2]

/// The steady flow under kAcceleration.
Real poiseuille(Real z, Real viscosity) {
  return kAcceleration / (2 * viscosity) * z * (kWidth - z);
}

/// A channel full of liquid, `across` particles from plate to plate.
Scene make_channel(int across, Real support, Real step) {
  const Real spacing = kWidth / across;
  const int along = static_cast<int>(std::ceil(2 * support));
  Scene scene = make_scene(IntegratorId::velocity_verlet, step);
  scene.dimensions = 2;
  scene.pressure_solver = PressureSolver::tait;
  LiquidConstants water{std::pow(20 * kPlateSpeed, 2), 1000 * kViscosity, support * spacing};
  water.artificial_viscosity = 0;
  scene.materials = {make_liquid("water", 1000, water)};
  scene.bodies = {
      make_body("water", BodyKind::liquid, "water",
                make_particles(make_lattice(along, 1, across, spacing), 1000 * spacing * spacing),
                spacing / 2)};
  scene.bodies[0].position = {0, 0, kWidth / 2};
  const Real half = along * spacing / 2;
  scene.periodic = Periodicity{Vec3(-half, 0, 0), Vec3(half, 0, 0), {true, false, false}};
  scene.vat = Vat{Vec3(-half, -half, 0), Vec3(half, half, kWidth), true, {}, {}};
  scene.vat->walls[4].no_slip = scene.vat->walls[5].no_slip = true;
  return scene;
}

/// Of shear along the axes of the lattice at rest: the central force is too weak there and too
/// strong along its diagonals (LIQ-5).
Real lattice_viscosity(Real support) {
  const SmoothingKernel kernel(KernelId::wendland_c2, support, 2);
  const int reach = static_cast<int>(support);
  Real sum = 0;
  for (int x = -reach; x <= reach; ++x) {
    for (int z = -reach; z <= reach; ++z) {
      const Real r2 = x * x + z * z;
      if (r2 >= support * support) continue;
      sum -= 4 * x * x * z * z * kernel.slope_over_r(std::sqrt(r2)) /
             (r2 + 0.01 * support * support / 4);
    }
  }
  return kViscosity * sum / lattice_slope(kernel, support, 1, 2);
}

// Steps ten times as long as explicit viscosity allows: the solve has the images too. After 2 s the
// flow is within 1e-8 of the steady one.
TEST(NoSlipWalls, ViscosityIsSolvedForInLongSteps) {
  Scene scene = make_channel(20, kSupport, 2.5e-3);
  scene.materials[0].liquid->stiffness = 0;
  scene.gravity = {kAcceleration, 0, 0};
  Simulation simulation = make_simulation(scene);
  advance_to(simulation, 2);
  const Real viscosity = lattice_viscosity(kSupport);
  const BodyView water = simulation.bodies()[0];
  for (std::size_t i = 0; i < water.positions.size(); ++i) {
    const Real expected = poiseuille(water.positions[i].z(), viscosity);
    EXPECT_NEAR(water.velocities[i].x(), expected, 0.02 * poiseuille(kWidth / 2, viscosity));
  }
}

// A closed box with sticky walls takes all motion out of the liquid, and its energy never grows. In
// a box of the width L velocities decay with at least 3 pi^2 nu / L^2.
TEST(NoSlipWalls, OnlyTakeEnergy) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.pressure_solver = PressureSolver::tait;
  scene.materials = {make_liquid("honey", 1000, {1, 50, 0.3})};
  scene.bodies = {make_body("honey", BodyKind::liquid, "honey",
                            make_particles(make_lattice(5, 5, 5, 0.1), 1), 0.05)};
  scene.bodies[0].angular_velocity = {0.1, 0.2, 0.3};
  scene.vat = Vat{Vec3::Constant(-0.25), Vec3::Constant(0.25), true, {}, {}};
  for (Wall& wall : scene.vat->walls) wall.no_slip = true;
  Simulation simulation = make_simulation(scene);
  Real energy = simulation.diagnostics().kinetic_energy;
  const Real start = energy;
  for (int n = 0; n < 200; ++n) {
    advance_to(simulation, simulation.time() + 1e-3);
    const Real now = simulation.diagnostics().kinetic_energy;
    ASSERT_LT(now, energy * (1 + 1e-9)) << n;
    energy = now;
  }
  const Real rate = 3 * std::pow(std::numbers::pi / 0.5, 2) * 50 / 1000;
  EXPECT_LT(energy, std::exp(-2 * rate * 0.2) * start);
}

TEST(NoSlipWalls, GiveTheSameBitsForAnyThreadsAndFromASnapshot) {
  Scene scene = make_channel(12, 3, 2.5e-3);
  scene.vat->walls[5].velocity = {kPlateSpeed, 0, 0};
  expect_same_bits(scene, 20, 10);
}

}  // namespace
}  // namespace vat::no_slip_walls_test
