// External simulators in a scene, compared with closed-form solutions.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <numbers>

#include "core/coupling/coupled_simulation.h"
#include "tests/support/external_bodies.h"
#include "tests/support/scenes.h"

namespace vat::test::coupling_test {
namespace {

/// Returns sn, cn and dn of the modulus k by the descending Landen transformation (M. Abramowitz,
/// I. A. Stegun, Handbook of Mathematical Functions, 16.4).
std::array<Real, 3> jacobi(Real u, Real k) {
  constexpr std::size_t kSteps = 6;
  std::array<Real, kSteps + 1> a{1};
  std::array<Real, kSteps + 1> c{k};
  Real b = std::sqrt(1 - k * k);
  for (std::size_t n = 1; n <= kSteps; ++n) {
    a[n] = (a[n - 1] + b) / 2;
    c[n] = (a[n - 1] - b) / 2;
    b = std::sqrt(a[n - 1] * b);
  }
  Real phi = std::ldexp(a[kSteps] * u, static_cast<int>(kSteps));
  for (std::size_t n = kSteps; n > 0; --n) phi = (phi + std::asin(c[n] / a[n] * std::sin(phi))) / 2;
  const Real sn = std::sin(phi);
  return {sn, std::cos(phi), std::sqrt(1 - k * k * sn * sn)};
}

/// Angle of a pendulum that starts at rest: sin(angle / 2) = k cn / dn of omega t.
Real exact_angle(Real amplitude, Real omega, Real time) {
  const Real k = std::sin(amplitude / 2);
  const auto [sn, cn, dn] = jacobi(omega * time, k);
  return 2 * std::asin(k * cn / dn);
}

constexpr Real kLength = 0.8;
constexpr Real kGravity = 9.81;

/// A bob, and a ball beside its lowest position.
Scene bob_and_ball(Real step) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, step);
  scene.materials = {make_material("oak", 700)};
  scene.default_interface = {.stiffness = 4000, .damping = 0};
  BodyDescription bob;
  bob.name = "bob";
  bob.kind = BodyKind::rigid;
  bob.material = "oak";
  bob.shape = SphereShape{Vec3::Zero(), 0.1};
  bob.spacing = 0.05;
  bob.mass = 2;
  BodyDescription ball = bob;
  ball.name = "ball";
  ball.mass = 3;
  ball.position = {0.25, 0, -kLength};
  scene.bodies = {bob, ball};
  return scene;
}

TEST(Coupling, PendulumFollowsItsClosedFormSolution) {
  constexpr Real kAmplitude = 2;
  Scene scene = bob_and_ball(0.01);
  scene.bodies.pop_back();
  scene.gravity = {0, 0, -3};  // does not act on the pendulum, which has its own gravity
  CoupledSimulation coupled(Simulation::create(scene).value());
  auto owned = std::make_unique<PendulumBody>(
      PendulumBody::Settings{.length = kLength, .gravity = kGravity, .angle = kAmplitude});
  const PendulumBody& pendulum = *owned;
  ASSERT_TRUE(coupled.attach(*coupled.simulation().find_body("bob"), std::move(owned)));
  for (int n = 0; n < 20; ++n) {
    ASSERT_TRUE(coupled.advance(10));
    const Real time = coupled.simulation().time();
    const Real angle = exact_angle(kAmplitude, std::sqrt(kGravity / kLength), time);
    const RigidPose pose = *coupled.simulation().bodies()[0].pose;
    const Vec3 exact = kLength * Vec3(std::sin(angle), 0, -std::cos(angle));
    // Global error of Runge-Kutta 4 with steps of 1 ms: below (omega dt)^4 t omega = 1e-9.
    EXPECT_LE((pose.center_of_mass - exact).norm(), 1e-9) << time;
  }
  EXPECT_LE(pendulum.received.norm(), 1e-13);
}

TEST(Coupling, PendulumExchangesMomentumWithABall) {
  CoupledSimulation coupled(Simulation::create(bob_and_ball(1e-3)).value());
  auto owned = std::make_unique<PendulumBody>(
      PendulumBody::Settings{.length = kLength, .gravity = kGravity, .angle = -0.8});
  const PendulumBody& pendulum = *owned;
  ASSERT_TRUE(coupled.attach(*coupled.simulation().find_body("bob"), std::move(owned)));
  const Real energy = pendulum.energy();
  for (int n = 0; n < 100; ++n) {
    ASSERT_TRUE(coupled.advance(10));
    const Vec3 momentum = 3 * coupled.simulation().bodies()[1].pose->velocity;
    EXPECT_LE((momentum + pendulum.received).norm(), 1e-13);
  }
  // The contact is elastic. Its 40 ms have 40 steps, so that the error of the energy is small.
  const RigidPose ball = *coupled.simulation().bodies()[1].pose;
  EXPECT_GT(ball.velocity.x(), 0.5);
  const Vec3 spin = coupled.simulation().rigid_momentum(2)->angular;
  const Real after =
      pendulum.energy() + 3 * ball.velocity.squaredNorm() / 2 + spin.dot(ball.angular_velocity) / 2;
  EXPECT_NEAR(after / energy, 1, 0.005);
}

constexpr Real kChainMass = 0.1;
constexpr Real kChainStiffness = 200;
constexpr Eigen::Index kLinks = 6;

/// A chain without springs, whose particles have the given velocities along x, and a mass that
/// touches its end with a compression of 0.05 m.
Scene chain_and_mass(Real step, const Eigen::VectorXd& velocities) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, step);
  scene.materials = {make_material("steel")};
  scene.default_interface = {.stiffness = 500, .damping = 0};
  std::vector<Vec3> places;
  for (Eigen::Index i = 0; i < kLinks; ++i) places.emplace_back(0.5 * static_cast<Real>(i), 0, 0);
  ParticleShape chain = make_particles(places, kChainMass);
  for (const Real velocity : velocities) chain.velocities.emplace_back(velocity, 0, 0);
  ParticleShape mass = make_particles({{0.5 * (kLinks - 1) + 0.15, 0, 0}}, 1.5);
  scene.bodies = {make_body("chain", BodyKind::deformable, "steel", chain, 0.1),
                  make_body("mass", BodyKind::deformable, "steel", mass, 0.1)};
  return scene;
}

TEST(Coupling, ChainVibratesInItsModes) {
  // Free chain: omega = 2 sqrt(k / m) sin(pi j / 2 n), shape cos(pi j (i + 1/2) / n).
  constexpr int kMode = 3;
  constexpr Real kTurn = std::numbers::pi * kMode / kLinks;
  Eigen::VectorXd shape(kLinks);
  for (Eigen::Index i = 0; i < kLinks; ++i) {
    shape[i] = 0.2 * std::cos(kTurn * (static_cast<Real>(i) + 0.5));
  }
  Scene scene = chain_and_mass(0.02, shape);
  scene.bodies.pop_back();
  CoupledSimulation coupled(Simulation::create(scene).value());
  ASSERT_TRUE(coupled.attach(1, std::make_unique<ChainBody>(kChainStiffness)));
  ASSERT_TRUE(coupled.advance(100));
  const Real omega = 2 * std::sqrt(kChainStiffness / kChainMass) * std::sin(kTurn / 2);
  const BodyView chain = coupled.simulation().bodies()[0];
  for (std::size_t i = 0; i < chain.positions.size(); ++i) {
    const Real speed = shape[static_cast<Eigen::Index>(i)];
    EXPECT_NEAR(chain.velocities[i].x(), speed * std::cos(omega * 2), 1e-12);
    EXPECT_NEAR(chain.positions[i].x() - 0.5 * static_cast<Real>(i),
                speed / omega * std::sin(omega * 2), 1e-13);
  }
}

/// Returns the exact displacements of chain and mass at `time`, while they touch.
Eigen::VectorXd exact_displacements(Real time) {
  constexpr Real kCompression = 0.05;
  constexpr Real kContact = 500;
  constexpr Eigen::Index n = kLinks + 1;
  Eigen::MatrixXd stiffness = ChainBody::stiffness_matrix(n, kChainStiffness);
  stiffness(n - 2, n - 2) += kContact - kChainStiffness;
  stiffness(n - 1, n - 1) += kContact - kChainStiffness;
  stiffness(n - 2, n - 1) = stiffness(n - 1, n - 2) = -kContact;
  Eigen::VectorXd root_mass = Eigen::VectorXd::Constant(n, std::sqrt(kChainMass));
  root_mass[n - 1] = std::sqrt(1.5);
  const Eigen::MatrixXd scale = root_mass.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale * stiffness * scale);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(n);
  force[n - 2] = -kContact * kCompression;
  force[n - 1] = kContact * kCompression;
  // From rest with a constant force: x = f / omega^2 (1 - cos omega t).
  const Eigen::VectorXd loads = solver.eigenvectors().transpose() * scale * force;
  Eigen::VectorXd places = Eigen::VectorXd::Zero(n);
  for (Eigen::Index m = 1; m < n; ++m) {
    const Real omega2 = solver.eigenvalues()[m];
    places[m] = loads[m] / omega2 * (1 - std::cos(std::sqrt(omega2) * time));
  }
  return scale * solver.eigenvectors() * places;
}

struct ChainRun {
  Real error = 0;
  Real momentum = 0;  ///< greatest sum of the momenta [kg m/s]
};

ChainRun run_chain(int steps) {
  constexpr Real kTime = 0.015;  // 1 radian of the contact, which opens after a quarter period
  CoupledSimulation coupled(
      Simulation::create(chain_and_mass(kTime / steps, Eigen::VectorXd::Zero(kLinks))).value());
  auto owned = std::make_unique<ChainBody>(kChainStiffness);
  const ChainBody& chain = *owned;
  EXPECT_TRUE(coupled.attach(1, std::move(owned)));
  ChainRun run;
  for (int n = 0; n < steps; ++n) {
    EXPECT_TRUE(coupled.advance(1));
    Real momentum = 0;
    for (const BodyView& body : coupled.simulation().bodies()) {
      for (std::size_t i = 0; i < body.masses.size(); ++i) {
        momentum += body.masses[i] * body.velocities[i].x();
      }
    }
    run.momentum = std::max(run.momentum, std::abs(momentum));
  }
  const Eigen::VectorXd exact = exact_displacements(kTime);
  const std::vector<BodyView> bodies = coupled.simulation().bodies();
  EXPECT_NEAR(chain.received.x(), -1.5 * bodies[1].velocities[0].x(), 1e-14);
  for (Eigen::Index i = 0; i < kLinks; ++i) {
    const Real place = bodies[0].positions[static_cast<std::size_t>(i)].x();
    run.error = std::max(run.error, std::abs(place - 0.5 * static_cast<Real>(i) - exact[i]));
  }
  const Real mass = bodies[1].positions[0].x() - (0.5 * (kLinks - 1) + 0.15);
  run.error = std::max(run.error, std::abs(mass - exact[kLinks]));
  return run;
}

TEST(Coupling, ChainAgainstAMassHasOrderTwoAndConservesMomentum) {
  const ChainRun coarse = run_chain(16);
  const ChainRun fine = run_chain(32);
  EXPECT_NEAR(std::log2(coarse.error / fine.error), 2, 0.2);
  EXPECT_LE(coarse.error, 1e-3);
  EXPECT_LE(coarse.momentum, 1e-14);
  EXPECT_LE(fine.momentum, 1e-14);
}

TEST(Coupling, MotorTurnsAPaddleInWater) {
  constexpr Real kRate = 4;
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.pressure_solver = PressureSolver::tait;
  scene.pair_precision = PairPrecision::double_precision;
  scene.materials = {make_liquid("water", 1000, {100, 0.5, 0.06, 0.05}), make_material("oak", 700)};
  scene.default_interface = {.stiffness = 4000, .damping = 5};
  BodyDescription water;
  water.name = "water";
  water.material = "water";
  water.shape = BoxShape{Vec3::Zero(), {0.18, 0.18, 0.18}};
  water.spacing = 0.03;
  water.position = {0.2, 0, 0};
  BodyDescription paddle;
  paddle.name = "paddle";
  paddle.kind = BodyKind::rigid;
  paddle.material = "oak";
  paddle.shape = BoxShape{Vec3::Zero(), {0.54, 0.18, 0.06}};
  paddle.spacing = 0.03;
  paddle.orientation = Quat(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitY()));
  scene.bodies = {water, paddle};
  CoupledSimulation coupled(Simulation::create(scene).value());
  auto owned = std::make_unique<MotorBody>(kRate);
  const MotorBody& motor = *owned;
  ASSERT_TRUE(coupled.attach(2, std::move(owned)));
  ASSERT_TRUE(coupled.advance(300));

  const std::vector<BodyView> bodies = coupled.simulation().bodies();
  const Eigen::AngleAxisd turn(kRate * 0.3 - std::numbers::pi / 2, Vec3::UnitY());
  EXPECT_LE(bodies[1].pose->orientation.angularDistance(Quat(turn)), 1e-12);
  EXPECT_LE(bodies[1].pose->center_of_mass.norm(), 1e-12);
  Vec3 momentum = Vec3::Zero();
  Real sum = 0;
  Real energy = 0;
  for (std::size_t i = 0; i < bodies[0].masses.size(); ++i) {
    momentum += bodies[0].masses[i] * bodies[0].velocities[i];
    sum += bodies[0].masses[i] * bodies[0].velocities[i].norm();
    energy += bodies[0].masses[i] * bodies[0].velocities[i].squaredNorm() / 2;
  }
  EXPECT_GT(momentum.norm(), 0.1 * sum);
  EXPECT_LE((momentum + motor.received).norm(), 1e-13 * sum);
  // The motor supplies the energy of the water and its losses.
  EXPECT_GT(motor.work, energy);
  EXPECT_GT(energy, 0.1 * motor.work);
}

}  // namespace
}  // namespace vat::test::coupling_test
