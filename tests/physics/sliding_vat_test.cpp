#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "tests/support/scenes.h"

// Forces of the walls of a sliding vat on its contents.

namespace vat::sliding_vat_test {
namespace {

using namespace test;

constexpr Real kMass = 2;
constexpr Real kStroke = 0.2;
constexpr Real kPeriod = 0.8;
constexpr Real kRate = 2 * std::numbers::pi / kPeriod;
constexpr InterfaceConstants kWall{400, 3};

/// One particle that both end walls press all the time.
Scene make_pressed_particle(BodyKind kind, IntegratorId integrator) {
  Scene scene = make_scene(integrator, 5e-4);
  scene.materials = {make_liquid("m", 1000, {100, 0, 0.1})};
  scene.vat = Vat{{-0.1, -5, -5}, {0.1, 5, 5}, true, SlideMotion{{1, 0, 0}, kStroke, kPeriod}};
  scene.interfaces = {{{"m", kVatMaterial}, kWall, 0.25}};
  scene.bodies = {make_body("body", kind, "m", make_particles({Vec3::Zero()}, kMass), 0.05)};
  return scene;
}

/// The exact motion: y = x - u of m y'' + 2 c y' + 2 k y = -m u'' with u = A (1 - cos(W t)) / 2
/// starts at rest. There are two walls, so the constants are doubled.
struct Motion {
  Real position;
  Real velocity;
};
Motion exact_motion(Real time) {
  using Complex = std::complex<Real>;
  const Complex i(0, 1);
  const Real damping = kWall.damping / kMass;  // half of 2 c / m
  const Real omega2 = 2 * kWall.stiffness / kMass;
  const Complex forced =
      -kStroke / 2 * kRate * kRate / (omega2 - kRate * kRate + 2.0 * i * damping * kRate);
  const Complex root = -damping + i * std::sqrt(omega2 - damping * damping);
  // The free part b e^(root t) cancels value and rate of the forced part at the start.
  const Real value = -forced.real();
  const Real rate = -(i * kRate * forced).real();
  const Complex free(value, -(rate - root.real() * value) / root.imag());
  const Complex y_forced = forced * std::exp(i * kRate * time);
  const Complex y_free = free * std::exp(root * time);
  const Real vat = kStroke / 2 * (1 - std::cos(kRate * time));
  const Real vat_speed = kStroke / 2 * kRate * std::sin(kRate * time);
  return {vat + (y_forced + y_free).real(),
          vat_speed + (i * kRate * y_forced + root * y_free).real()};
}

TEST(SlidingVat, GivesEveryKindTheMomentumOfTheClosedForm) {
  for (const BodyKind kind : {BodyKind::liquid, BodyKind::deformable, BodyKind::rigid}) {
    Simulation simulation =
        make_simulation(make_pressed_particle(kind, IntegratorId::runge_kutta_4));
    Real greatest = 0;
    for (int n = 0; n < 100; ++n) {
      simulation.advance(40);
      const Motion exact = exact_motion(simulation.time());
      const BodyDiagnostics body = simulation.diagnostics().bodies[0];
      EXPECT_NEAR(body.center_of_mass.x(), exact.position, 1e-9) << to_string(kind);
      EXPECT_NEAR(body.linear_momentum.x(), kMass * exact.velocity, 1e-8) << to_string(kind);
      EXPECT_EQ(body.linear_momentum.y(), 0);
      EXPECT_EQ(body.linear_momentum.z(), 0);
      greatest = std::max(greatest, body.linear_momentum.norm());
    }
    EXPECT_GT(greatest, 1);
  }
}

// The error of a method of order p decreases by 2^p if the step is halved, although the forces
// depend on time. Each stage uses the vat's position at its time.
TEST(SlidingVat, ObservedOrderIsThatOfEachMethod) {
  for (const auto& [integrator, order] :
       {std::pair(IntegratorId::explicit_euler, 1), std::pair(IntegratorId::symplectic_euler, 1),
        std::pair(IntegratorId::heun, 2), std::pair(IntegratorId::runge_kutta_4, 4)}) {
    const auto error = [integrator = integrator](Real step) {
      Scene scene = make_pressed_particle(BodyKind::rigid, integrator);
      scene.numerics.step = scene.numerics.tick = step;
      Simulation simulation = make_simulation(scene);
      advance_to(simulation, 0.5);
      return std::abs(position_of(simulation, 0).x() - exact_motion(0.5).position);
    };
    EXPECT_NEAR(std::log2(error(5e-4) / error(2.5e-4)), order, 0.2) << to_string(integrator);
  }
}

}  // namespace
}  // namespace vat::sliding_vat_test
