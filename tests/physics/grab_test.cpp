#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/scenes.h"

// A grabbed body receives energy from the grab's spring only.

namespace vat::grab_test {
namespace {

using namespace test;

constexpr Real kStep = 1e-3;
constexpr std::uint64_t kHand = 1;
constexpr Real kFrequency = 4 * std::numbers::pi;  // [rad/s] of the spring
constexpr Real kMaxDampingRatio = 0.5;  // momentum change of the grabbed particles per step

Vec3 center_of(const Simulation& simulation) {
  return simulation.diagnostics().bodies[0].center_of_mass;
}

/// The effect of a grab on a body at rest.
struct Pull {
  Index particle;
  Vec3 offset;     ///< target relative to the particle [m]
  Real felt_mass;  ///< effective mass of the grabbed particles [kg]
};

/// Returns the initial energy of the spring, k |offset|^2 / 2. The spring is critically damped for
/// the body's mass, or for a smaller mass if its damper would reverse the particles' velocity. The
/// damper only dissipates, so the body never has more energy. Its centre is never faster than 2 Hz
/// times the offset. The limit of the grab's force is a dozen times the force here.
Real first_energy(const Simulation& simulation, const Pull& pull) {
  const Real most = kMaxDampingRatio * pull.felt_mass / (2 * kFrequency * kStep);
  const Real mass = std::min(simulation.diagnostics().bodies[0].mass, most);
  return 0.5 * mass * kFrequency * kFrequency * pull.offset.squaredNorm();
}

/// Expects the bound of energy until `time`, every ten steps. Velocity Verlet conserves an energy
/// that differs from the true one by at most (omega dt)^2 / 8. This is below 1 %, since omega dt <
/// 0.3.
void expect_no_more_than_first_energy(Simulation& simulation, const Pull& pull, Real time) {
  const Vec3 target = position_of(simulation, 0, pull.particle) + pull.offset;
  const Real most = 1.01 * first_energy(simulation, pull);
  const BodyId id = simulation.bodies()[0].id;
  ASSERT_TRUE(simulation.grab_start(kHand, id, pull.particle, target).ok());
  while (simulation.time() < time) {
    ASSERT_EQ(simulation.advance(10).undone_steps, 0U) << simulation.time();
    const Diagnostics now = simulation.diagnostics();
    ASSERT_LE(now.kinetic_energy + now.elastic_energy, most) << simulation.time();
  }
}

/// Expects that the grabbed particle is at rest. A rigid body may continue to rotate about it.
void expect_rest_at(const Simulation& simulation, Index particle, const Vec3& target,
                    Real tolerance) {
  EXPECT_LT((position_of(simulation, 0, particle) - target).norm(), tolerance);
  EXPECT_LT(velocity_of(simulation, 0, particle).norm(), kFrequency * tolerance);
}

Scene make_scene_of(BodyDescription body) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, kStep);
  scene.materials = {make_material("m")};
  scene.bodies = {std::move(body)};
  return scene;
}

/// n^3 particles of 0.1 kg, 5 cm apart, joined by springs to their 26 neighbours. The highest
/// frequency is at most sqrt(2 * 26 / 3 * k / m) = 260 rad/s.
Scene make_cube(int n) {
  const std::vector<Vec3> points = make_lattice(n, n, n, 0.05);
  BodyDescription body =
      make_body("cube", BodyKind::deformable, "m", make_particles(points, 0.1), 0.025);
  body.springs = join_near(points, 0.09, {400, 4});
  return make_scene_of(body);
}

/// Returns the mass of the particles within three diameters, 0.15 m.
Real held_mass(const BodyView& body, Index particle) {
  Real mass = 0;
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Real distance = (body.positions[i] - body.positions[particle]).norm();
    if (distance < 0.15 + 1e-9) mass += body.masses[i];
  }
  return mass;
}

/// Returns a grab of the middle of a cube of side^3 particles, 10 cm along x.
Pull pull_of_middle(const Simulation& cube, Index side) {
  const Index middle = side / 2 * (1 + side + side * side);
  return {middle, {0.1, 0, 0}, held_mass(cube.bodies()[0], middle)};
}

// The cube has 1382 kg, of which 12 kg are grabbed. A damper for the whole mass would reverse their
// velocity threefold in a step.
TEST(GrabbedBody, ALargeBlockIsNotThrown) {
  Simulation simulation = make_simulation(make_cube(24));
  const Pull pull = pull_of_middle(simulation, 24);
  const Vec3 start = center_of(simulation);
  expect_no_more_than_first_energy(simulation, pull, 1);
  EXPECT_GT((center_of(simulation) - start).x(), 0.05);
}

// A cube with an odd side has a particle at its centre, so the block does not rotate.
TEST(GrabbedBody, ABlockComesToRestAtTheTarget) {
  Simulation simulation = make_simulation(make_cube(15));
  const Pull pull = pull_of_middle(simulation, 15);
  const Vec3 target = position_of(simulation, 0, pull.particle) + pull.offset;
  const Vec3 center = center_of(simulation) + pull.offset;
  expect_no_more_than_first_energy(simulation, pull, 5);
  expect_rest_at(simulation, pull.particle, target, 1e-3);
  EXPECT_LT((center_of(simulation) - center).norm(), 1e-3);
}

/// Eleven particles along x, 1 m long.
BodyDescription make_rod() {
  return make_body("rod", BodyKind::rigid, "m", make_particles(make_lattice(11, 1, 1, 0.1), 0.2),
                   1e-3);
}

// A transverse force at the end of a uniform rod acts on about a quarter of its mass: 1 / (1 / M +
// l^2 / I).
TEST(GrabbedBody, ARodIsPulledByItsEnd) {
  for (const Vec3& offset : {Vec3(0, 0.1, 0), Vec3(0.06, 0, -0.08)}) {
    Simulation simulation = make_simulation(make_scene_of(make_rod()));
    const Real inertia = 0.2 * 2 * (0.01 + 0.04 + 0.09 + 0.16 + 0.25);
    const Pull pull{10, offset, 1 / (1 / 2.2 + 0.25 / inertia)};
    const Vec3 target = position_of(simulation, 0, 10) + offset;
    expect_no_more_than_first_energy(simulation, pull, 5);
    expect_rest_at(simulation, 10, target, 1e-3);
  }
}

// A body of 1 kg with a particle of 1 g on an arm of 0.5 m. The effective mass at the particle is 5
// g.
TEST(GrabbedBody, ALightParticleBesideAHeavyOneIsHeldGently) {
  ParticleShape shape = make_particles({{0, 0, 0}, {0.5, 0, 0}}, 1);
  shape.masses = {1, 1e-3};
  shape.radii = {0.05, 0.01};
  BodyDescription body = make_body("lump", BodyKind::rigid, "m", shape, 0.05);
  body.radius.reset();
  Simulation simulation = make_simulation(make_scene_of(body));
  const Real inertia = 0.4 * (0.0025 + 1e-7) + 0.25 * 1e-3 / 1.001;
  const Real arm = 0.5 / 1.001;
  const Pull pull{1, {0, 0.1, 0}, 1 / (1 / 1.001 + arm * arm / inertia)};
  const Vec3 target = position_of(simulation, 0, 1) + pull.offset;
  expect_no_more_than_first_energy(simulation, pull, 10);
  expect_rest_at(simulation, 1, target, 1e-3);
}

}  // namespace
}  // namespace vat::grab_test
