#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/scenes.h"

// A grabbed body receives energy from the grab's spring only.

namespace vat::test::grab_test {
namespace {

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

Simulation make_simulation_of(const BodyDescription& body) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, kStep, {make_material("m")});
  scene.bodies = {body};
  return make_simulation(scene);
}

// The cube has 1382 kg, of which the 12 kg within three diameters (0.15 m) are grabbed. A damper
// for the whole mass would reverse their velocity threefold in a step. The highest frequency of the
// springs is at most sqrt(2 * 26 / 3 * k / m) = 260 rad/s.
TEST(GrabbedBody, ALargeBlockIsNotThrown) {
  constexpr Index kSide = 24;
  constexpr Index kMiddle = kSide / 2 * (1 + kSide + kSide * kSide);
  const std::vector<Vec3> points = make_lattice(kSide, kSide, kSide, 0.05);
  BodyDescription body =
      make_body("cube", BodyKind::deformable, "m", make_particles(points, 0.1), 0.025);
  body.springs = join_near(points, 0.09, {400, 4});
  const auto held = std::ranges::count_if(
      points, [&](const Vec3& p) { return (p - points[kMiddle]).norm() < 0.15 + 1e-9; });
  Simulation simulation = make_simulation_of(body);
  const Pull pull{kMiddle, {0.1, 0, 0}, 0.1 * static_cast<Real>(held)};
  const Vec3 start = center_of(simulation);
  expect_no_more_than_first_energy(simulation, pull, 1);
  EXPECT_GT((center_of(simulation) - start).x(), 0.05);
}

// A body of 1 kg with a particle of 1 g on an arm of 0.5 m. The effective mass at the particle is 5
// g.
TEST(GrabbedBody, ALightParticleBesideAHeavyOneIsHeldGently) {
  ParticleShape shape = make_particles({{0, 0, 0}, {0.5, 0, 0}}, 1);
  shape.masses = {1, 1e-3};
  shape.radii = {0.05, 0.01};
  BodyDescription body = make_body("lump", BodyKind::rigid, "m", shape, 0.05);
  body.radius.reset();
  Simulation simulation = make_simulation_of(body);
  const Real inertia = 0.4 * (0.0025 + 1e-7) + 0.25 * 1e-3 / 1.001;
  const Real arm = 0.5 / 1.001;
  const Pull pull{1, {0, 0.1, 0}, 1 / (1 / 1.001 + arm * arm / inertia)};
  const Vec3 target = position_of(simulation, 0, 1) + pull.offset;
  expect_no_more_than_first_energy(simulation, pull, 10);
  EXPECT_LT((position_of(simulation, 0, 1) - target).norm(), 1e-3);
  EXPECT_LT(velocity_of(simulation, 0, 1).norm(), kFrequency * 1e-3);
}

}  // namespace
}  // namespace vat::test::grab_test
