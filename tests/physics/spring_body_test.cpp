#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/scenes.h"

// Bodies of several springs against closed forms and against numbers of an independent solver
// (the cases DEF-2 to DEF-6).

namespace vat::spring_body_test {
namespace {

using namespace test;

constexpr Real kGravity = 9.81;

Scene make_spring_scene(IntegratorId integrator, Real step, ParticleShape shape,
                        std::vector<SpringDescription> springs) {
  Scene scene = make_scene(integrator, step);
  scene.materials = {make_material("rubber")};
  scene.bodies = {make_body("body", BodyKind::deformable, "rubber", std::move(shape), 0.01)};
  scene.bodies[0].springs = std::move(springs);
  return scene;
}

constexpr int kMasses = 16;
constexpr Real kSpacing = 0.1;

/// DEF-2: masses of 0.1 between walls, in the n-th mode with the given amplitude along `axis`.
Scene make_chain(int n, const Vec3& axis, Real amplitude, Real step) {
  std::vector<Vec3> positions;
  std::vector<SpringDescription> springs;
  for (int i = 0; i <= kMasses + 1; ++i) {
    const Real shape = std::sin(n * i * std::numbers::pi / (kMasses + 1));
    positions.push_back(Vec3(i * kSpacing, 0, 0) + amplitude * shape * axis);
    const auto a = static_cast<Index>(i);
    if (i <= kMasses) springs.push_back({a, a + 1, {400, 0}, 0.08});
  }
  ParticleShape shape = make_particles(positions, 0.1);
  shape.fixed = {0, kMasses + 1};
  return make_spring_scene(IntegratorId::velocity_verlet, step, shape, springs);
}

/// Runs 20 periods of the mode and compares with cos of the angle that Verlet is known to turn by,
/// 2 asin(omega dt / 2) a step.
void expect_mode(int n, const Vec3& axis, Real omega, Real tolerance) {
  constexpr Real kStep = 1e-3;
  constexpr Real kAmplitude = 1e-5;
  Simulation simulation = make_simulation(make_chain(n, axis, kAmplitude, kStep));
  const auto steps = static_cast<std::uint32_t>(20.13 * 2 * std::numbers::pi / omega / kStep);
  simulation.advance(steps);
  const Real angle = steps * 2 * std::asin(omega * kStep / 2);
  for (std::size_t i = 1; i <= kMasses; ++i) {
    const Real shape = std::sin(n * static_cast<Real>(i) * std::numbers::pi / (kMasses + 1));
    const Vec3 moved = position_of(simulation, 0, i) - Vec3(static_cast<Real>(i) * kSpacing, 0, 0);
    EXPECT_NEAR(moved.dot(axis) / kAmplitude, shape * std::cos(angle), tolerance)
        << "mode " << n << ", mass " << i;
  }
}

TEST(SpringBody, ChainSwingsInItsLongitudinalModes) {
  constexpr std::array<std::pair<int, Real>, 5> kModes{{{1, 11.671126874847422},
                                                        {2, 23.24267981032208},
                                                        {4, 45.693858036225464},
                                                        {8, 85.21650734625061},
                                                        {16, 125.951517646558}}};
  // Along the chain the springs are linear: only the round-off of positions near 1, 2e-16, over the
  // amplitude of 1e-5, adding up over 20 periods.
  for (const auto& [n, omega] : kModes) expect_mode(n, Vec3::UnitX(), omega, 1e-7);
}

TEST(SpringBody, ChainSwingsInItsTransverseModes) {
  constexpr std::array<std::pair<int, Real>, 5> kModes{{{1, 5.219486613236703},
                                                        {2, 10.394442407028418},
                                                        {4, 20.43491454464504},
                                                        {8, 38.10998064626531},
                                                        {16, 56.327231065393605}}};
  // Across it stiffness grows with the square of the slope, below (2e-5 / 0.1)^2 = 4e-8, times
  // k l / T = 4, over 127 radians.
  for (const auto& [n, omega] : kModes) {
    expect_mode(n, Vec3::UnitY(), omega, 5e-5);
    expect_mode(n, Vec3::UnitZ(), omega, 5e-5);
  }
}

// DEF-3a: ten masses of 0.1 hang on springs of stiffness 200: spring n carries all below it.
TEST(SpringBody, HangingChainStretchesByItsWeight) {
  std::vector<Vec3> positions;
  std::vector<SpringDescription> springs;
  for (Index i = 0; i <= 10; ++i) {
    positions.push_back({0, 0, -0.1 * i});
    if (i > 0) springs.push_back({i - 1, i, {200, 10}, 0.1});
  }
  ParticleShape shape = make_particles(positions, 0.1);
  shape.fixed = {0};
  Scene scene = make_spring_scene(IntegratorId::velocity_verlet, 1e-3, shape, springs);
  scene.gravity = {0, 0, -kGravity};
  Simulation simulation = make_simulation(scene);
  // The slowest mode, 6.7 rad/s, decays as exp(-c omega^2 t / (2 k)) = exp(-1.1 t).
  advance_to(simulation, 25);
  const std::array<Real, 10> expected = {-0.14905,  -0.293195, -0.432435, -0.56677, -0.6962,
                                         -0.820725, -0.940345, -1.05506,  -1.16487, -1.269775};
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_NEAR(position_of(simulation, 0, i + 1).z(), expected[i], 1e-9);
  }
}

// DEF-4: a mass of 1 on a spring of stiffness 1e4 and length 1, let go level with its pivot.
TEST(SpringBody, ElasticPendulumFollowsTheReference) {
  const auto error_of = [](IntegratorId integrator) {
    ParticleShape shape = make_particles({{0, 0, 0}, {1, 0, 0}}, 1);
    shape.fixed = {0};
    Scene scene = make_spring_scene(integrator, 1e-3, shape, {{0, 1, {1e4, 0}, 1.0}});
    scene.gravity = {0, -kGravity, 0};
    Simulation simulation = make_simulation(scene);
    advance_to(simulation, 5);
    return (position_of(simulation, 0, 1) - Vec3(0.9497943777441625, -0.3158171423754525, 0))
        .norm();
  };
  // Errors of an independent implementation at this step, to the digits given.
  EXPECT_LT(error_of(IntegratorId::symplectic_euler), 1.35e-3);
  EXPECT_LT(error_of(IntegratorId::velocity_verlet), 1.75e-5);
  EXPECT_LT(error_of(IntegratorId::heun), 5.85e-5);
  EXPECT_LT(error_of(IntegratorId::runge_kutta_4), 1.15e-8);
}

/// DEF-5: cantilever of 11 x 3 x 3 nodes with axial springs and face diagonals; face x = 0 fixed.
Scene make_cantilever(IntegratorId integrator, Real step) {
  std::vector<Vec3> positions = make_lattice(11, 3, 3, 0.1);
  for (Vec3& p : positions) p += Vec3(0.5, 0.1, 0.1);
  std::vector<SpringDescription> springs;
  for (SpringDescription& spring : join_near(positions, 0.15, {1000, 0})) {
    const Real length = (positions[spring.a] - positions[spring.b]).norm();
    if (length < 0.11) spring.constants.stiffness = 2000;
    springs.push_back(spring);
  }
  ParticleShape shape = make_particles(positions, 0.01);
  for (Index i = 0; i < positions.size(); ++i) {
    if (positions[i].x() < 0.01) shape.fixed.push_back(i);
  }
  Scene scene = make_spring_scene(integrator, step, shape, springs);
  scene.gravity = {0, 0, -kGravity};
  return scene;
}

TEST(SpringBody, CantileverFallsAsTheReferenceDoes) {
  constexpr std::size_t kTip = 10 + 11 * (1 + 3 * 1);
  const auto error_of = [](IntegratorId integrator, Real step) {
    Simulation simulation = make_simulation(make_cantilever(integrator, step));
    EXPECT_EQ(simulation.spring_count(), 550U);
    advance_to(simulation, 0.5);
    Real error = std::abs(position_of(simulation, 0, kTip).z() - 0.100371449);
    advance_to(simulation, 1);
    error = std::max(error, std::abs(position_of(simulation, 0, kTip).z() - 0.1006585908));
    return std::max(error, std::abs(position_of(simulation, 0, kTip).x() - 0.999905512));
  };
  // Greatest excited frequency times step is below 0.3: RK4 errs by z^4/120 of a deflection of
  // 0.17 over at most a thousand radians, far above the 1e-10 of the reference.
  EXPECT_LT(error_of(IntegratorId::runge_kutta_4, 2.5e-4), 1e-7);
  // Second order once the stiffest mode, 1172 rad/s, is well resolved.
  const Real coarse = error_of(IntegratorId::velocity_verlet, 1.25e-4);
  const Real fine = error_of(IntegratorId::velocity_verlet, 6.25e-5);
  EXPECT_LT(coarse, 1e-4);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.2);
}

// DEF-6a: on a circle the spring's pull is the centripetal force: k (L - l) = m omega^2 L / 2.
TEST(SpringBody, SpinningDumbbellKeepsItsLength) {
  constexpr Real kLength = 8.0 / 7;
  ParticleShape shape = make_particles({{-kLength / 2, 0, 0}, {kLength / 2, 0, 0}}, 1);
  shape.velocities = {{0, -5 * kLength / 2, 0}, {0, 5 * kLength / 2, 0}};
  const Scene scene =
      make_spring_scene(IntegratorId::velocity_verlet, 1e-3, shape, {{0, 1, {100, 0}, 1.0}});
  Simulation simulation = make_simulation(scene);
  const Diagnostics start = simulation.diagnostics();
  EXPECT_NEAR(start.kinetic_energy + start.elastic_energy, 9.183673469387752, 1e-12);
  EXPECT_NEAR(start.bodies[0].angular_momentum.z(), 3.265306122448979, 1e-13);
  // Verlet's circle differs in radius by a part of order (omega dt)^2 = 2.5e-5.
  for (int n = 0; n < 100; ++n) {
    simulation.advance(100);
    const Real length = (position_of(simulation, 0, 0) - position_of(simulation, 0, 1)).norm();
    EXPECT_NEAR(length, kLength, 2.5e-5 * kLength);
  }
  EXPECT_NEAR(simulation.diagnostics().bodies[0].angular_momentum.z(), 3.265306122448979, 1e-12);
}

/// DEF-6b: eight masses of 0.25 at the corners of a unit cube, all pairs joined, turning and
/// moving.
Scene make_spinning_cube(IntegratorId integrator, Real step) {
  std::vector<Vec3> positions = make_lattice(2, 2, 2, 1);
  ParticleShape shape = make_particles(positions, 0.25);
  for (const Vec3& p : positions) {
    shape.velocities.push_back(Vec3(0.3, -0.2, 0.1) + Vec3(1, 2, 3).cross(p));
  }
  return make_spring_scene(integrator, step, shape, join_near(positions, 2, {50, 0}));
}

struct CubeErrors {
  Real position;
  Real momentum;
  Real angular_momentum;
  Real energy;
};
CubeErrors spin_cube(IntegratorId integrator, Real step) {
  Simulation simulation = make_simulation(make_spinning_cube(integrator, step));
  EXPECT_EQ(simulation.spring_count(), 28U);
  advance_to(simulation, 5);
  const Diagnostics d = simulation.diagnostics();
  const Vec3 corner = position_of(simulation, 0, 7);
  return {(corner - Vec3(2.0231027811705, -0.673253969117949, 1.103749089254949)).norm(),
          (d.bodies[0].linear_momentum - Vec3(0.6, -0.4, 0.2)).norm(),
          (d.bodies[0].angular_momentum - Vec3(1, 2, 3)).norm(),
          std::abs(d.kinetic_energy + d.elastic_energy - 7.14) / 7.14};
}

TEST(SpringBody, SpinningCubeFollowsTheReference) {
  // Errors of an independent implementation at t = 5, to the digits given; momentum is exact for
  // all methods, angular momentum for the symplectic ones.
  for (const auto& [step, position, energy] :
       {std::tuple(1e-2, 8.45e-3, 2.5e-4), std::tuple(1e-3, 6.95e-5, 1.45e-6)}) {
    const CubeErrors verlet = spin_cube(IntegratorId::velocity_verlet, step);
    EXPECT_LT(verlet.position, position);
    EXPECT_LT(verlet.energy, energy);
    EXPECT_LT(verlet.momentum, 1e-13);
    EXPECT_LT(verlet.angular_momentum, 1e-12);
  }
  for (const auto& [step, position, spin] :
       {std::tuple(1e-2, 1.15e-4, 2.5e-6), std::tuple(1e-3, 1.65e-8, 3.5e-11)}) {
    const CubeErrors rk4 = spin_cube(IntegratorId::runge_kutta_4, step);
    EXPECT_LT(rk4.position, position);
    EXPECT_LT(rk4.angular_momentum, spin);
    EXPECT_LT(rk4.momentum, 1e-13);
  }
  for (const auto& [step, position, spin] :
       {std::tuple(1e-2, 1.15e-2, 2.5e-3), std::tuple(1e-3, 2.85e-4, 1.5e-6)}) {
    const CubeErrors heun = spin_cube(IntegratorId::heun, step);
    EXPECT_LT(heun.position, position);
    EXPECT_LT(heun.angular_momentum, spin);
    EXPECT_LT(heun.momentum, 1e-13);
  }
}

}  // namespace
}  // namespace vat::spring_body_test
