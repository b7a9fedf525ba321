#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "tests/support/scenes.h"

// The exact discrete solution of each integrator. DEF-1 covers orders, damping and energy.

namespace vat::test::oscillator_test {
namespace {

using Complex = std::complex<Real>;

constexpr Real kOmega = 10;     // sqrt(100 / 1) [rad/s]
constexpr Real kStretch = 0.2;  // initial extension [m]

/// Returns x - l + i v / omega, which rotates as exp(-i omega t).
Complex phase_point(const Simulation& simulation) {
  return {position_of(simulation, 0, 1).x() - 1, velocity_of(simulation, 0, 1).x() / kOmega};
}

// For both methods, x(n+1) - 2 x(n) + x(n-1) = -z^2 x(n), so sin(theta/2) = z/2 per step. Their
// first steps differ: x(1) = (1 - z^2/2) x(0) and (1 - z^2) x(0).
TEST(Oscillator, SymplecticMethodsTurnByTheirKnownAngle) {
  for (const Real step : {0.001, 0.01, 0.05, 0.1}) {
    const Real z = kOmega * step;
    const Real theta = 2 * std::asin(z / 2);
    constexpr int kSteps = 777;
    Simulation verlet = make_advanced(
        make_oscillator(IntegratorId::velocity_verlet, step, {kOmega * kOmega, 0}, 1 + kStretch),
        kSteps);
    EXPECT_NEAR(phase_point(verlet).real(), kStretch * std::cos(kSteps * theta), 1e-11) << step;
    EXPECT_NEAR(phase_point(verlet).imag(),
                -kStretch * std::sqrt(1 - z * z / 4) * std::sin(kSteps * theta), 1e-11)
        << step;
    Simulation euler = make_advanced(
        make_oscillator(IntegratorId::symplectic_euler, step, {kOmega * kOmega, 0}, 1 + kStretch),
        kSteps);
    const Real sine = -z * z / 2 / std::sin(theta);
    EXPECT_NEAR(phase_point(euler).real(),
                kStretch * (std::cos(kSteps * theta) + sine * std::sin(kSteps * theta)), 1e-11)
        << step;
  }
}

// x'' = g has a quadratic solution, which is exact for every method of order 2 or more. The Euler
// methods differ by g dt t / 2, one to either side.
TEST(Oscillator, FreeFallIsExact) {
  Scene scene = make_scene(IntegratorId::heun, 0.01);
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_material("stone")};
  for (const BodyKind kind : {BodyKind::deformable, BodyKind::rigid}) {
    for (const IntegratorId integrator : kIntegrators) {
      scene.numerics.integrator = integrator;
      scene.bodies = {make_body("stone", kind, "stone", make_particles({{1, 2, 3}}, 0.7), 0.1)};
      scene.bodies[0].velocity = {4, 0, 5};
      Simulation simulation = make_simulation(scene);
      advance_to(simulation, 2);
      Vec3 expected(1 + 4 * 2, 2, 3 + 5 * 2 - 9.81 / 2 * 4);
      if (integrator == IntegratorId::explicit_euler) expected.z() += 9.81 * 0.01 * 2 / 2;
      if (integrator == IntegratorId::symplectic_euler) expected.z() -= 9.81 * 0.01 * 2 / 2;
      EXPECT_LT((position_of(simulation, 0) - expected).norm(), 1e-12) << to_string(integrator);
      EXPECT_LT((velocity_of(simulation, 0) - Vec3(4, 0, 5 - 9.81 * 2)).norm(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace vat::test::oscillator_test
