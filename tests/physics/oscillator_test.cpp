#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "tests/support/scenes.h"

// One mass on one spring: every integrator's discrete solution is known, not only its limit.

namespace vat::oscillator_test {
namespace {

using namespace test;

using Complex = std::complex<Real>;

constexpr Real kOmega = 10;     // sqrt(100 / 1) [rad/s]
constexpr Real kStretch = 0.2;  // at the start [m]

/// Mass 1 at x = 1.2 on a spring of stiffness 100 and length 1 to the origin; E = 2.
Scene make_oscillator(IntegratorId integrator, Real step, Real damping = 0) {
  Scene scene = make_scene(integrator, step);
  scene.materials = {make_material("rubber")};
  ParticleShape shape = make_particles({{0, 0, 0}, {1 + kStretch, 0, 0}}, 1);
  shape.fixed = {0};
  scene.bodies = {make_body("oscillator", BodyKind::deformable, "rubber", shape, 0.01)};
  scene.bodies[0].springs = {{0, 1, {kOmega * kOmega, damping}, 1.0}};
  return scene;
}

/// x - l + i v / omega, which turns as exp(-i omega t).
Complex phase_point(const Simulation& simulation) {
  return {position_of(simulation, 0, 1).x() - 1, velocity_of(simulation, 0, 1).x() / kOmega};
}

/// The Runge-Kutta methods' polynomials: a step multiplies the phase point by R(-i z).
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
  constexpr int kSteps = 150;  // explicit Euler has grown to 0.42 by then, still short of the pivot
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

// x(n+1) - 2 x(n) + x(n-1) = -z^2 x(n) for both, so sin(theta/2) = z/2 a step; their first steps
// differ: x(1) = (1 - z^2/2) x(0) and (1 - z^2) x(0).
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

// DEF-1: x(10) and v(10) of the exact solution. A frequency error of omega z^2/24 (Verlet),
// z^2/6 (Heun), z^4/120 (RK4) turns the phase by omega t times that; the amplitude of Heun grows
// by z^4/8 and that of RK4 shrinks by z^6/144 a step.
TEST(Oscillator, ErrorAfterTenSecondsIsThatOfTheory) {
  const Complex exact(0.1724637744575368, 1.0127312822195176 / kOmega);
  for (const Real step : {0.01, 0.001}) {
    const Real z = kOmega * step;
    const Real turns = kOmega * 10;
    const auto error_of = [&](IntegratorId integrator) {
      Simulation simulation = make_simulation(make_oscillator(integrator, step));
      advance_to(simulation, 10);
      return std::abs(phase_point(simulation) - exact);
    };
    EXPECT_NEAR(error_of(IntegratorId::heun), kStretch * turns * z * z / 6,
                0.05 * kStretch * turns * z * z / 6);
    const Real fourth = kStretch * turns * std::pow(z, 4) / 120;
    EXPECT_NEAR(error_of(IntegratorId::runge_kutta_4), fourth, 0.1 * fourth);
    // The velocity of Verlet is also small by z^2/8 where it is greatest.
    const Real second = kStretch * turns * z * z / 24;
    EXPECT_NEAR(error_of(IntegratorId::velocity_verlet), second, 0.1 * second);
  }
}

Real order_of(IntegratorId integrator, Real damping, const Complex& exact) {
  const auto error_of = [&](Real step) {
    Simulation simulation = make_simulation(make_oscillator(integrator, step, damping));
    advance_to(simulation, 1);
    return std::abs(phase_point(simulation) - exact);
  };
  return std::log2(error_of(0.002) / error_of(0.001));
}

TEST(Oscillator, ObservedOrderIsThatOfEachMethod) {
  const Complex exact = kStretch * std::exp(Complex(0, -kOmega));
  EXPECT_NEAR(order_of(IntegratorId::explicit_euler, 0, exact), 1, 0.2);
  EXPECT_NEAR(order_of(IntegratorId::symplectic_euler, 0, exact), 1, 0.2);
  EXPECT_NEAR(order_of(IntegratorId::velocity_verlet, 0, exact), 2, 0.2);
  EXPECT_NEAR(order_of(IntegratorId::heun, 0, exact), 2, 0.2);
  EXPECT_NEAR(order_of(IntegratorId::runge_kutta_4, 0, exact), 4, 0.2);
}

/// DEF-1c, damping 2: decay 1 /s, omega_d = sqrt(99).
Complex damped_point(Real t) {
  const Real w = std::sqrt(99.0);
  const Real decay = std::exp(-t);
  return {kStretch * decay * (std::cos(w * t) + std::sin(w * t) / w),
          -kStretch * decay * (kOmega / w) * std::sin(w * t)};
}

TEST(Oscillator, DampedSolutionIsTheReference) {
  EXPECT_NEAR(damped_point(1).real(), 0.9326296638819174 - 1, 1e-14);
  Simulation simulation = make_simulation(make_oscillator(IntegratorId::runge_kutta_4, 0.001, 2));
  advance_to(simulation, 0.1);
  // |lambda| = 10: each second turns by 10 and errs by (10 dt)^4/120 of it.
  const Real bound = kStretch * 10 * 1e-8 / 120;
  EXPECT_NEAR(position_of(simulation, 0, 1).x(), 1.11379437818922, bound);
  advance_to(simulation, 2);
  EXPECT_NEAR(position_of(simulation, 0, 1).x(), 1.0158232047237925, 2 * bound);
}

TEST(Oscillator, ObservedOrderWithDampingIsThatOfEachMethod) {
  const Complex exact = damped_point(1);
  EXPECT_NEAR(order_of(IntegratorId::explicit_euler, 2, exact), 1, 0.2);
  EXPECT_NEAR(order_of(IntegratorId::symplectic_euler, 2, exact), 1, 0.2);
  EXPECT_NEAR(order_of(IntegratorId::velocity_verlet, 2, exact), 2, 0.2);
  EXPECT_NEAR(order_of(IntegratorId::heun, 2, exact), 2, 0.2);
  EXPECT_NEAR(order_of(IntegratorId::runge_kutta_4, 2, exact), 4, 0.2);
}

TEST(Oscillator, DampingOnlyTakesEnergy) {
  for (const IntegratorId integrator : {IntegratorId::heun, IntegratorId::runge_kutta_4}) {
    Simulation simulation = make_simulation(make_oscillator(integrator, 0.002, 2));
    Real before = 2;
    for (int n = 0; n < 200; ++n) {
      simulation.advance(5);
      const Diagnostics d = simulation.diagnostics();
      EXPECT_LT(d.kinetic_energy + d.elastic_energy, before);
      before = d.kinetic_energy + d.elastic_energy;
    }
  }
}

Real energy_error(IntegratorId integrator, Real step, int steps) {
  Simulation simulation = make_simulation(make_oscillator(integrator, step));
  Real worst = 0;
  for (int n = 0; n < steps; ++n) {
    simulation.advance(1);
    const Diagnostics d = simulation.diagnostics();
    worst = std::max(worst, std::abs((d.kinetic_energy + d.elastic_energy) / 2 - 1));
  }
  return worst;
}

TEST(Oscillator, EnergyAtTheStartIsHalfKStretchSquared) {
  const Diagnostics d = make_simulation(make_oscillator(IntegratorId::heun, 0.01)).diagnostics();
  EXPECT_NEAR(d.elastic_energy, 2, 1e-14);
  EXPECT_EQ(d.kinetic_energy, 0);
}

// Verlet's energy swings by z^2/4 and comes back for ever: after ten thousand steps as after one
// hundred. The others gain (1 + z^2)^n (explicit Euler), n z^4/4 (Heun) or lose n z^6/72 (RK4).
TEST(Oscillator, EnergyErrorsAreThoseOfTheory) {
  constexpr Real kStep = 0.01;
  const Real z = kOmega * kStep;
  EXPECT_NEAR(energy_error(IntegratorId::velocity_verlet, kStep, 100), z * z / 4, 0.01 * z * z);
  EXPECT_NEAR(energy_error(IntegratorId::velocity_verlet, kStep, 10000), z * z / 4, 0.01 * z * z);
  EXPECT_LT(energy_error(IntegratorId::symplectic_euler, kStep, 10000), 1.1 * z / 2);
  EXPECT_NEAR(energy_error(IntegratorId::explicit_euler, kStep, 100), std::pow(1 + z * z, 100) - 1,
              1e-9);
  EXPECT_NEAR(energy_error(IntegratorId::heun, kStep, 1000), 1000 * std::pow(z, 4) / 4,
              0.05 * 1000 * std::pow(z, 4) / 4);
  EXPECT_NEAR(energy_error(IntegratorId::runge_kutta_4, kStep, 1000), 1000 * std::pow(z, 6) / 72,
              0.05 * 1000 * std::pow(z, 6) / 72);
}

// DEF-1b: masses 1 and 3 on a spring of stiffness 100 and length 1, 1.3 apart, free.
TEST(Oscillator, FreePairSwingsWithTheReducedMass) {
  Scene scene = make_scene(IntegratorId::runge_kutta_4, 0.001);
  scene.materials = {make_material("rubber")};
  ParticleShape shape = make_particles({{0, 0, 0}, {1.3, 0, 0}}, 1);
  shape.masses = {1, 3};
  scene.bodies = {make_body("pair", BodyKind::deformable, "rubber", shape, 0.01)};
  scene.bodies[0].springs = {{0, 1, {100, 0}, 1.0}};
  Simulation simulation = make_simulation(scene);
  advance_to(simulation, 10);
  // omega = 11.547: z^4/120 of 115 radians of an amplitude of 0.3.
  const Real bound = 0.3 * 115.5 * std::pow(0.011547, 4) / 120;
  EXPECT_NEAR(position_of(simulation, 0, 0).x(), 0.3867061101293303, bound);
  EXPECT_NEAR(position_of(simulation, 0, 1).x() - position_of(simulation, 0, 0).x(),
              0.7843918531608931, 1.4 * bound);
}

// x'' = g has a solution of second degree: exact for every method of order 2 or more, and Verlet;
// the Euler methods miss by g dt t / 2, one on either side.
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
