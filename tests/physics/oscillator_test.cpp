#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "tests/support/scenes.h"

// The exact discrete solution of each integrator. DEF-1 covers orders, damping and energy.

namespace vat::oscillator_test {
namespace {

using namespace test;

using Complex = std::complex<Real>;

constexpr Real kOmega = 10;     // sqrt(100 / 1) [rad/s]
constexpr Real kStretch = 0.2;  // initial extension [m]

/// A mass of 1 at x = 1.2 on a spring of stiffness 100 and length 1 to the origin.
Scene make_oscillator(IntegratorId integrator, Real step) {
  Scene scene = make_scene(integrator, step);
  scene.materials = {make_material("rubber")};
  ParticleShape shape = make_particles({{0, 0, 0}, {1 + kStretch, 0, 0}}, 1);
  shape.fixed = {0};
  scene.bodies = {make_body("oscillator", BodyKind::deformable, "rubber", shape, 0.01)};
  scene.bodies[0].springs = {{0, 1, {kOmega * kOmega, 0}, 1.0}};
  return scene;
}

/// Returns x - l + i v / omega, which rotates as exp(-i omega t).
Complex phase_point(const Simulation& simulation) {
  return {position_of(simulation, 0, 1).x() - 1, velocity_of(simulation, 0, 1).x() / kOmega};
}

/// Returns the polynomial R(-i z) of a Runge-Kutta method. A step multiplies the phase point by it.
Complex stability(IntegratorId integrator, Complex z) {
  switch (integrator) {
    case IntegratorId::explicit_euler:
      return 1.0 + z;
    case IntegratorId::heun:
      return 1.0 + z + z * z / 2.0;
    default:
      return 1.0 + z + z * z / 2.0 + z * z * z / 6.0 + z * z * z * z / 24.0;
  }
}

TEST(Oscillator, RungeKuttaMethodsFollowTheirStabilityPolynomials) {
  constexpr Real kStep = 0.01;
  constexpr int kSteps =
      150;  // explicit Euler reaches 0.42, which is less than the distance to the pivot
  for (const IntegratorId integrator :
       {IntegratorId::explicit_euler, IntegratorId::heun, IntegratorId::runge_kutta_4}) {
    Simulation simulation = make_simulation(make_oscillator(integrator, kStep));
    const Complex factor = stability(integrator, {0, -kOmega * kStep});
    simulation.advance(kSteps);
    const Complex expected = kStretch * std::pow(factor, kSteps);
    EXPECT_LT(std::abs(phase_point(simulation) - expected), 1e-12 * std::abs(expected) + 1e-13)
        << to_string(integrator);
  }
}

// For both methods, x(n+1) - 2 x(n) + x(n-1) = -z^2 x(n), so sin(theta/2) = z/2 per step. Their
// first steps differ: x(1) = (1 - z^2/2) x(0) and (1 - z^2) x(0).
TEST(Oscillator, SymplecticMethodsTurnByTheirKnownAngle) {
  for (const Real step : {0.001, 0.01, 0.05, 0.1}) {
    const Real z = kOmega * step;
    const Real theta = 2 * std::asin(z / 2);
    constexpr int kSteps = 777;
    Simulation verlet = make_simulation(make_oscillator(IntegratorId::velocity_verlet, step));
    verlet.advance(kSteps);
    EXPECT_NEAR(phase_point(verlet).real(), kStretch * std::cos(kSteps * theta), 1e-11) << step;
    EXPECT_NEAR(phase_point(verlet).imag(),
                -kStretch * std::sqrt(1 - z * z / 4) * std::sin(kSteps * theta), 1e-11)
        << step;
    Simulation euler = make_simulation(make_oscillator(IntegratorId::symplectic_euler, step));
    euler.advance(kSteps);
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
}  // namespace vat::oscillator_test
