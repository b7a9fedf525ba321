#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/mixed_scenes.h"
#include "tests/support/same_bits.h"

// Projection contacts in steps of 1/60 s and longer. RIG-9 compares them with closed forms.

namespace vat::projection_test {
namespace {

using namespace test;

constexpr Real kFrame = 1.0 / 60;
constexpr Real kRadius = 0.05;  // [m]

InterfaceConstants projection(Real friction = 0, Real restitution = 0) {
  return {.friction = friction, .law = InterfaceLaw::projection, .restitution = restitution};
}

Scene make_floor_scene(Real step) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, step);
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_material("steel")};
  scene.vat = Vat{{-20, -20, 0}, {20, 20, 20}, false, {}, {}};
  return scene;
}

BodyDescription make_ball(const std::string& name, const Vec3& position) {
  BodyDescription ball =
      make_body(name, BodyKind::rigid, "steel", make_particles({{0, 0, 0}}, 1), kRadius);
  ball.position = position;
  return ball;
}

/// A block that stands on a face of 4 x 4 particles.
BodyDescription make_plate(const std::string& name, Real height) {
  BodyDescription block =
      make_body(name, BodyKind::rigid, "steel",
                make_particles(make_lattice(4, 4, 2, 2 * kRadius), 0.5), kRadius);
  block.position.z() = height;
  return block;
}

Real height_of(const Simulation& simulation, std::size_t body = 0) {
  return simulation.bodies()[body].pose->center_of_mass.z();
}

TEST(Projection, PartsWithTheRestitutionAtAnyStep) {
  for (const IntegratorId integrator :
       {IntegratorId::velocity_verlet, IntegratorId::symplectic_euler}) {
    for (const Real step : {kFrame, 1.0 / 240, 1e-3}) {
      for (const Real e : {0.0, 0.3, 0.7, 1.0}) {
        Scene scene = make_floor_scene(step);
        scene.gravity.setZero();
        scene.numerics.integrator = integrator;
        scene.default_interface = projection(0, e);
        scene.bodies = {make_ball("ball", {0, 0, 0.3})};
        scene.bodies[0].velocity = {0.5, 0, -2};
        Simulation simulation = make_simulation(scene);
        advance_to(simulation, step * std::ceil(0.3 / step));
        EXPECT_NEAR(velocity_of(simulation, 0).z(), 2 * e, 1e-12) << step;
        EXPECT_NEAR(velocity_of(simulation, 0).x(), 0.5, 1e-12);
      }
    }
  }
}

TEST(Projection, NeverGainsEnergyInACollision) {
  for (const Real step : {1e-3, 4e-3, kFrame, 0.05}) {
    Scene scene =
        make_collision(BodyKind::rigid, BodyKind::rigid, IntegratorId::velocity_verlet, step);
    scene.default_interface = projection(0.4, 0.3);
    Simulation simulation = make_simulation(scene);
    const Real before = simulation.diagnostics().kinetic_energy;
    simulation.advance(static_cast<std::uint32_t>(std::ceil(0.3 / step)));
    const Real after = simulation.diagnostics().kinetic_energy;
    EXPECT_LT(after, before) << step;
    EXPECT_GT(after, 0.05 * before) << step;
  }
}

TEST(Projection, SeparatesInitialOverlapsWithoutVelocity) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, kFrame);
  scene.materials = {make_material("steel")};
  scene.default_interface = projection();
  scene.bodies = {make_plate("a", 0), make_plate("b", 3.1 * kRadius)};
  Simulation simulation = make_simulation(scene);
  advance_to(simulation, 60 * kFrame);
  EXPECT_NEAR(height_of(simulation, 1) - height_of(simulation, 0), 4 * kRadius, 1e-5);
  EXPECT_LT(simulation.diagnostics().kinetic_energy, 1e-8);
}

TEST(Projection, CarriesBodiesOnASlidingVat) {
  Scene scene = make_floor_scene(kFrame);
  scene.default_interface = projection(0.8);
  scene.vat->motion = SlideMotion{{1, 0, 0}, 0.4, 2};  // at most 2 m/s^2
  scene.bodies = {make_plate("block", 2 * kRadius)};
  Simulation simulation = make_simulation(scene);
  advance_to(simulation, 60 * kFrame);
  EXPECT_NEAR(position_of(simulation, 0).x() + 3 * kRadius, 0.4, 1e-5);
}

TEST(Projection, GivesTheSameBitsForAnyThreadsAndFromASnapshot) {
  Scene scene = make_crowd(IntegratorId::velocity_verlet, 4e-3);
  scene.default_interface = projection(0.4, 0.3);
  expect_same_bits(scene, 20, 10);
}

TEST(Projection, OfTooManyContactsFailsTheStep) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, kFrame);
  scene.materials = {make_material("steel")};
  scene.default_interface = projection();
  std::vector<Vec3> points;
  for (int i = 0; i < 750; ++i) points.emplace_back(1e-5 * i, 0, 0);  // 562 500 pairs
  for (const char* name : {"a", "b"}) {
    scene.bodies.push_back(
        make_body(name, BodyKind::deformable, "steel", make_particles(points, 1e-3), kRadius));
  }
  Simulation simulation = make_simulation(scene);
  const std::uint64_t before = simulation.state_hash();
  const AdvanceReport report = simulation.advance(1);
  EXPECT_TRUE(report.failed);
  EXPECT_EQ(report.events.at(0).cause, GuardEvent::Cause::too_many_pairs);
  EXPECT_EQ(simulation.state_hash(), before);
}

TEST(Projection, DoesNotLimitAdaptiveSteps) {
  Scene scene = make_floor_scene(kFrame);
  scene.default_interface = projection(0.5);
  scene.numerics.control = StepControl::adaptive;
  scene.bodies = {make_plate("block", 2 * kRadius)};
  Simulation simulation = make_simulation(scene);
  EXPECT_EQ(simulation.advance(60).steps, 60U);
}

// If no contact exerts a force, the damping solve has no contact terms.
TEST(Projection, GoesWithDashpotsThatStepsDoNotResolve) {
  Scene scene = make_floor_scene(kFrame);
  scene.default_interface = projection();
  scene.bodies = {make_body("dumbbell", BodyKind::deformable, "steel",
                            make_particles({{0, 0, 0.1}, {0.3, 0, 0.1}}, 1), kRadius),
                  make_ball("ball", {0, 0, 0.25})};
  scene.bodies[0].springs = {{0, 1, {10, 1e4}, {}}};
  Simulation simulation = make_simulation(scene);
  const AdvanceReport report = simulation.advance(60);
  EXPECT_TRUE(report.events.empty());
  for (const Index particle : {0U, 1U}) {
    EXPECT_NEAR(position_of(simulation, 0, particle).z(), kRadius, 1e-9);
  }
  EXPECT_GT(height_of(simulation, 1), kRadius - 1e-9);
}

}  // namespace
}  // namespace vat::projection_test
