#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/shaken_vat.h"
#include "tests/support/totals.h"

// An applied force acts for whole steps, and its impulse is force times duration.

namespace vat::test::applied_force_test {
namespace {

constexpr Real kStep = 1e-3;
const Vec3 kForce(3, -20, 7);

// Momenta are about 4 kg m/s. Each is the sum of at most 54 particles after at most 40 steps. This
// gives a hundred roundings of half an epsilon, and as many of the cancelling forces.
constexpr Real kRoundOff = 4 * 200 * std::numeric_limits<Real>::epsilon();

Vec3 total_momentum(const Simulation& simulation) {
  return totals_of(simulation.diagnostics()).momentum;
}

Scene make_moving_block(IntegratorId integrator, BodyKind kind) {
  Scene scene = make_two_material_scene(integrator, kStep);
  scene.bodies = {make_block("block", kind, "a", 3, {1, 2, 3}, {1, 0, 0})};
  return scene;
}

struct Duration {
  Real in_steps;
  std::uint32_t whole_steps;
};
constexpr Duration kDurations[] = {{0.3, 1}, {1, 1}, {10, 10}, {10.5, 11}};

/// Returns the angular momentum about the centre of mass of the first body.
Vec3 spin_of(const Simulation& simulation) {
  const BodyDiagnostics body = simulation.diagnostics().bodies[0];
  return body.angular_momentum - body.center_of_mass.cross(body.linear_momentum);
}

/// Expects that every step adds the same fraction of the impulse to the momentum, and no spin.
void expect_equal_shares(const Scene& scene, const Duration& duration,
                         std::uint32_t earlier_steps) {
  Simulation simulation = make_advanced(scene, earlier_steps);
  const Vec3 before = total_momentum(simulation);
  const Vec3 spin = spin_of(simulation);
  const Vec3 impulse = duration.in_steps * kStep * kForce;
  const BodyId id = simulation.bodies()[0].id;
  ASSERT_TRUE(simulation.apply_force(id, kForce, duration.in_steps * kStep).ok());
  for (std::uint32_t n = 1; n <= duration.whole_steps + 3; ++n) {
    ASSERT_TRUE(simulation.advance(1).events.empty());
    const Real share = std::min<Real>(1, static_cast<Real>(n) / duration.whole_steps);
    EXPECT_LT((total_momentum(simulation) - before - share * impulse).norm(), kRoundOff)
        << "step " << n << " of " << duration.in_steps;
  }
  EXPECT_LT((spin_of(simulation) - spin).norm(), 1e-4);
}

// Velocity Verlet reuses the forces of a step's end in the next step. Both edges of the force must
// be sharp there too.
TEST(AppliedForce, GivesEachStepAnEqualShareOfItsImpulse) {
  for (const IntegratorId integrator : kIntegrators) {
    for (const BodyKind kind : kBodyKinds) {
      SCOPED_TRACE(std::string(to_string(integrator)) + " " + to_string(kind));
      for (const Duration& duration : kDurations) {
        expect_equal_shares(make_moving_block(integrator, kind), duration, 0);
        expect_equal_shares(make_moving_block(integrator, kind), duration, 7);
      }
    }
  }
}

TEST(AppliedForce, OverlappingForcesEachGiveTheirImpulse) {
  for (const IntegratorId integrator : kIntegrators) {
    Simulation simulation = make_simulation(make_moving_block(integrator, BodyKind::rigid));
    const Vec3 before = total_momentum(simulation);
    const BodyId id = simulation.bodies()[0].id;
    ASSERT_TRUE(simulation.apply_force(id, kForce, 4 * kStep).ok());
    simulation.advance(2);
    ASSERT_TRUE(simulation.apply_force(id, {-5, 0, 0}, 7.5 * kStep).ok());
    simulation.advance(20);
    const Vec3 expected = 4 * kStep * kForce + 7.5 * kStep * Vec3(-5, 0, 0);
    EXPECT_LT((total_momentum(simulation) - before - expected).norm(), kRoundOff)
        << to_string(integrator);
  }
}

// The guard divides a step into parts. Each part must receive its share of the force.
TEST(AppliedForce, GivesItsImpulseInStepsThatAreTakenInParts) {
  for (const IntegratorId integrator : kIntegrators) {
    Scene scene = make_two_material_scene(integrator, kStep);
    scene.bodies = {make_block("fast", BodyKind::rigid, "a", 1, {0, 0, 0}, {60, 0, 0}),
                    make_block("other", BodyKind::rigid, "b", 1, {9, 9, 9}, Vec3::Zero())};
    Simulation simulation = make_simulation(scene);
    const Vec3 before = total_momentum(simulation);
    const BodyId id = simulation.bodies()[0].id;
    ASSERT_TRUE(simulation.apply_force(id, kForce, 10.5 * kStep).ok());
    EXPECT_EQ(simulation.advance(15).undone_steps, 15U);
    EXPECT_LT((total_momentum(simulation) - before - 10.5 * kStep * kForce).norm(), 3 * kRoundOff)
        << to_string(integrator);
  }
}

}  // namespace
}  // namespace vat::test::applied_force_test
