#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/support/scenes.h"

// Start-up of the flow between two plates (LIQ-7): Couette flow, where one plate moves, and
// Poiseuille flow, where a force drives the liquid.

namespace vat::channel_flow_test {
namespace {

using namespace test;

constexpr Real kViscosity = 1e-6;      // kinematic [m^2/s]
constexpr Real kWidth = 1e-3;          // between the plates [m]
constexpr Real kPlateSpeed = 1.25e-5;  // [m/s]
constexpr Real kAcceleration = 1e-4;   // [m/s^2]

Real couette(Real z, Real t) {
  Real sum = kPlateSpeed * z / kWidth;
  for (int n = 1; n < 100; ++n) {
    const Real k = n * std::numbers::pi / kWidth;
    sum += 2 * kPlateSpeed / (n * std::numbers::pi) * (n % 2 == 0 ? 1 : -1) * std::sin(k * z) *
           std::exp(-kViscosity * k * k * t);
  }
  return sum;
}

Real poiseuille(Real z, Real t) {
  Real sum = kAcceleration / (2 * kViscosity) * z * (kWidth - z);
  for (int n = 1; n < 100; n += 2) {
    const Real k = n * std::numbers::pi / kWidth;
    sum -= 4 * kAcceleration / (kViscosity * kWidth * k * k * k) * std::sin(k * z) *
           std::exp(-kViscosity * k * k * t);
  }
  return sum;
}

/// `across` particles from plate to plate, with kernels of `support` spacings.
Scene make_channel(int across, Real support) {
  const Real spacing = kWidth / across;
  const int along = static_cast<int>(std::ceil(2 * support));
  Scene scene = make_scene(IntegratorId::velocity_verlet, 2.5e-4);
  scene.dimensions = 2;
  scene.materials = {make_liquid("water", 1000, {0, 1000 * kViscosity, support * spacing})};
  scene.bodies = {
      make_body("water", BodyKind::liquid, "water",
                make_particles(make_lattice(along, 1, across, spacing), 1000 * spacing * spacing),
                spacing / 2)};
  scene.bodies[0].position = {0, 0, kWidth / 2};
  const Real half = along * spacing / 2;
  scene.periodic = Periodicity{Vec3(-half, 0, 0), Vec3(half, 0, 0), {true, false, false}};
  scene.vat = Vat{Vec3(-half, -half, 0), Vec3(half, half, kWidth), true, {}, {}};
  scene.vat->walls[4].no_slip = scene.vat->walls[5].no_slip = true;
  scene.forces.pressure = false;
  scene.forces.walls = false;
  return scene;
}

/// Relative error of the velocities along the plates in the mean square, the greatest of three
/// times; the first is when the edge of the moving liquid is three kernels wide.
Real error_of(const Scene& scene, const std::function<Real(Real, Real)>& exact) {
  Simulation simulation = make_simulation(scene);
  Real worst = 0;
  for (const Real time : {0.0225, 0.1125, 0.225}) {
    advance_to(simulation, time);
    const BodyView water = simulation.bodies()[0];
    Real error = 0;
    Real square = 0;
    for (std::size_t i = 0; i < water.positions.size(); ++i) {
      const Real expected = exact(water.positions[i].z(), time);
      error += std::pow(water.velocities[i].x() - expected, 2);
      square += expected * expected;
    }
    worst = std::max(worst, std::sqrt(error / square));
  }
  return worst;
}

TEST(ChannelFlow, CouetteFlowStartsAsTheory) {
  Scene scene = make_channel(20, 3.5);
  scene.vat->walls[5].velocity = {kPlateSpeed, 0, 0};
  EXPECT_LT(error_of(scene, couette), 0.02);
}

TEST(ChannelFlow, PoiseuilleFlowStartsAsTheory) {
  Scene scene = make_channel(20, 3.5);
  scene.gravity = {kAcceleration, 0, 0};
  EXPECT_LT(error_of(scene, poiseuille), 0.02);
}

TEST(ChannelFlow, ConvergesWithTheSpacing) {
  Scene coarse = make_channel(20, 3.5);
  Scene fine = make_channel(40, 3.5);
  fine.numerics = {IntegratorId::velocity_verlet, 6.25e-5, 6.25e-5};
  for (Scene* scene : {&coarse, &fine}) scene->vat->walls[5].velocity = {kPlateSpeed, 0, 0};
  EXPECT_LT(error_of(fine, couette), 0.5 * error_of(coarse, couette));
}

}  // namespace
}  // namespace vat::channel_flow_test
