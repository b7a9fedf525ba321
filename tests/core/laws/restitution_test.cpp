#include "core/laws/contact_damping.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scenes.h"

namespace vat::test::restitution_test {
namespace {

// Closed-form values of RIG-4 of the validation. Those above 1 were integrated with steps of 1e-5.
TEST(Restitution, OfDampingRatiosIsThatOfTheUnilateralSpring) {
  EXPECT_EQ(restitution_of(0), 1);
  for (const auto& [ratio, restitution] : {std::pair{0.05, 0.858758102},
                                           {0.1, 0.744079398},
                                           {0.2, 0.571740028},
                                           {0.5, 0.298436059},
                                           {0.7, 0.210284564},
                                           {1.0, std::exp(-2)},
                                           {1.5, 0.075588309},
                                           {3.0, 0.023769514}}) {
    EXPECT_NEAR(restitution_of(ratio), restitution, 1e-9) << ratio;
  }
}

TEST(Restitution, IsInverted) {
  EXPECT_EQ(damping_ratio_for(1), 0);
  for (const Real e : {0.99, 0.5, 0.2, 0.1353, 0.05, 0.01}) {
    EXPECT_NEAR(restitution_of(damping_ratio_for(e)), e, 1e-12) << e;
  }
}

struct Impact {
  Real stiffness;
  Real first_mass;
  Real second_mass;
};
constexpr Impact kImpacts[] = {{1e3, 1, 1}, {1e5, 1, 1}, {1e4, 1, 100}, {1e4, 20, 0.5}};
constexpr Real kRestitutions[] = {1, 0.8, 0.5, 0.2, 0.05};

/// Returns the separation speed of two bodies whose nearest particles are about to touch. The first
/// body moves at 1 m/s along x. The step is 1/200 of the contact's angular period. `reduced_mass`
/// is that of the impact.
Real speed_of_parting(Scene scene, Real stiffness, Real reduced_mass, Real restitution) {
  const Real rate = std::sqrt(stiffness / reduced_mass);
  scene.numerics.step = scene.numerics.tick = 5e-3 / rate;
  scene.default_interface = {.stiffness = stiffness, .restitution = restitution};
  scene.bodies[0].velocity = {1, 0, 0};
  Simulation simulation = make_advanced(scene, 3000);
  const auto contact_speed = [&](std::size_t b, std::size_t particle) {
    return simulation.bodies()[b].velocities[particle].x();
  };
  return contact_speed(1, 0) - contact_speed(0, 0);
}

// If a damping force starts within a step, its error is at most half of the step.
constexpr Real kHalfStep = 5e-3;

TEST(Restitution, IsThatOfFreeAndRigidParticlesOfAnyMass) {
  for (const BodyKind kind : {BodyKind::deformable, BodyKind::rigid}) {
    for (const Impact& impact : kImpacts) {
      for (const Real e : kRestitutions) {
        Scene scene = make_scene(IntegratorId::velocity_verlet, 1, {make_material("steel")});
        scene.bodies = {
            make_body("a", kind, "steel", make_particles({{-0.1001, 0, 0}}, impact.first_mass),
                      0.05),
            make_body("b", kind, "steel", make_particles({{0, 0, 0}}, impact.second_mass), 0.05)};
        const Real mass =
            impact.first_mass * impact.second_mass / (impact.first_mass + impact.second_mass);
        EXPECT_NEAR(speed_of_parting(scene, impact.stiffness, mass, e), e, 2 * kHalfStep)
            << to_string(kind) << ' ' << impact.stiffness << ' ' << impact.first_mass;
      }
    }
  }
}

/// Two rigid blocks of 3 x 3 x 3 particles, 27 kg in all, flat against each other.
Scene make_blocks() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1, {make_material("steel")});
  const ParticleShape shape = make_particles(make_lattice(3, 3, 3, 0.1), 1);
  scene.bodies = {make_body("a", BodyKind::rigid, "steel", shape, 0.05),
                  make_body("b", BodyKind::rigid, "steel", shape, 0.05)};
  scene.bodies[0].position.x() = -0.3001;
  return scene;
}

// Nine springs act simultaneously.
TEST(Restitution, IsThatOfFacesThatMeetFlat) {
  for (const Real e : kRestitutions) {
    EXPECT_NEAR(speed_of_parting(make_blocks(), 1e4, 13.5 / 9, e), e, 2 * kHalfStep) << e;
  }
}

// The end of a rod is more mobile than its middle: its rotation contributes a term with the square
// of half the length.
TEST(Restitution, IsThatOfThePointThatIsHit) {
  for (const Real e : kRestitutions) {
    Scene scene = make_blocks();
    std::vector<Vec3> rod;
    for (int i = 0; i < 11; ++i) rod.push_back({0, 0.1 * i, 0});
    scene.bodies = {
        make_body("ball", BodyKind::rigid, "steel", make_particles({{0, 0, 0}}, 5), 0.05),
        make_body("rod", BodyKind::rigid, "steel", make_particles(rod, 1), 0.05)};
    scene.bodies[0].position.x() = -0.1001;
    // Moment of inertia of 11 kg about the centre: 1.1 kg m^2 of the positions, and the moment of
    // each sphere.
    const Real inertia = 1.1 + 11 * 0.4 * 0.05 * 0.05;
    const Real mobility = 1.0 / 5 + 1.0 / 11 + 0.25 / inertia;
    // The contact is stiff, so the rod does not turn during the impact.
    EXPECT_NEAR(speed_of_parting(scene, 1e8, 1 / mobility, e), e, 2 * kHalfStep) << e;
  }
}

TEST(Restitution, IsThatOfAFallOnTheFloor) {
  for (const Real e : kRestitutions) {
    Scene scene = make_blocks();
    scene.bodies.resize(1);
    scene.bodies[0].position = {0, 0, 0.1501};
    scene.bodies[0].velocity.z() = -1;
    scene.vat = Vat{{-1, -1, 0}, {1, 1, 2}, false, {}, {}};
    scene.default_interface = {.stiffness = 1e4, .restitution = e};
    scene.numerics.step = scene.numerics.tick = 5e-3 / std::sqrt(9e4 / 27);
    Simulation simulation = make_advanced(scene, 3000);
    EXPECT_NEAR(velocity_of(simulation, 0).z(), e, 2 * kHalfStep) << e;
  }
}

}  // namespace
}  // namespace vat::test::restitution_test
