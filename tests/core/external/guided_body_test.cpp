#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/errors.h"
#include "tests/support/name_of.h"
#include "tests/support/saved_bits.h"
#include "tests/support/scenes.h"

/// Driven bodies, and bodies with axles.
namespace vat::test::guided_body_test {
namespace {

constexpr Real kStep = 0.01;
const SlideMotion kSlide{{1, 0, 2}, 0.3, 0.8};

/// A plate of 0.9 kg with the inertia of its nine particles.
BodyDescription plate(const char* name, const Vec3& position) {
  BodyDescription body = make_body(name, BodyKind::rigid, "wood",
                                   make_particles(make_lattice(3, 1, 3, 0.1), 0.1), 0.05);
  body.position = position;
  return body;
}

BodyDescription driven(const Vec3& position) {
  BodyDescription body = plate("piston", position);
  body.motion = kSlide;
  return body;
}

BodyDescription wheel(const Vec3& direction, Real damping) {
  BodyDescription body = plate("wheel", Vec3::Zero());
  body.orientation = Quat(0.8, 0.36, 0, 0.48);
  body.axle = Axle{direction, damping};
  return body;
}

Scene scene_of(IntegratorId integrator, std::vector<BodyDescription> bodies) {
  Scene scene = make_scene(integrator, kStep);
  scene.gravity = {0, 0, -10};
  scene.materials = {make_material("wood")};
  scene.default_interface = {500, 1};
  scene.bodies = std::move(bodies);
  return scene;
}

Vec3 offset_at(Real time) {
  const Real share = (1 - std::cos(2 * std::numbers::pi * time / kSlide.period)) / 2;
  return kSlide.axis.normalized() * (kSlide.stroke * share);
}
Vec3 velocity_at(Real time) {
  const Real rate = 2 * std::numbers::pi / kSlide.period;
  return kSlide.axis.normalized() * (kSlide.stroke / 2 * rate * std::sin(rate * time));
}

/// Returns the moment of inertia of the plate about the axis `direction` through its centre.
Real moment_about(const BodyView& body, const Vec3& direction) {
  constexpr Real kSphere = 0.4;
  Real moment = 0;
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Vec3 arm = body.positions[i] - body.pose->center_of_mass;
    moment += body.masses[i] *
              (arm.cross(direction).squaredNorm() + kSphere * body.radii[i] * body.radii[i]);
  }
  return moment;
}

class GuidedBody : public testing::TestWithParam<IntegratorId> {};

TEST_P(GuidedBody, FollowsItsMotionThroughObstacles) {
  const Vec3 start{0.1, 0.2, 0.3};
  Scene scene = scene_of(GetParam(), {driven(start), plate("obstacle", {0.15, 0.2, 0.65})});
  scene.gravity = Vec3::Zero();
  Simulation simulation = make_simulation(scene);
  for (int step = 0; step < 160; ++step) {
    const AdvanceReport report = simulation.advance(1);
    ASSERT_TRUE(report.events.empty()) << to_string(report.events[0].cause);
    const RigidPose pose = *simulation.bodies()[0].pose;
    ASSERT_LT((pose.center_of_mass - start - offset_at(simulation.time())).norm(), 1e-13) << step;
    ASSERT_LT((pose.velocity - velocity_at(simulation.time())).norm(), 1e-13) << step;
    ASSERT_EQ(pose.angular_velocity, Vec3::Zero());
  }
  EXPECT_GT(simulation.bodies()[1].pose->velocity.z(), 0) << "the obstacle is pushed";
}

TEST_P(GuidedBody, ContinuesFromItsBytes) {
  Scene scene = scene_of(GetParam(), {driven({0, 0, 0}), wheel({0, 1, 0}, 0.01)});
  scene.bodies[1].position = {2, 0, 0};
  scene.bodies[1].angular_velocity = {0, 3, 0};
  Simulation simulation = make_advanced(scene, 13);
  expect_goes_on(simulation, 10);
}

TEST_P(GuidedBody, OnAnAxleTurnsByTheTorqueAlongItOnly) {
  const Vec3 direction = Vec3(1, 2, 2) / 3;
  Simulation simulation = make_simulation(scene_of(GetParam(), {wheel(2 * direction, 0)}));
  const Vec3 start = simulation.bodies()[0].positions[0];
  // Equal accelerations of all particles have no torque.
  ASSERT_TRUE(simulation.apply_force(simulation.bodies()[0].id, {5, 3, 1}, 0.1));
  advance_to(simulation, 0.1);
  EXPECT_LT(simulation.bodies()[0].pose->angular_velocity.norm(), 1e-15);
  // A far target pulls with a constant force up to 1e-6.
  const Vec3 pull{0, 1e6, 0};
  ASSERT_TRUE(simulation.grab_start(1, simulation.bodies()[0].id, 0, start + pull));
  simulation.advance(1);
  const RigidPose pose = *simulation.bodies()[0].pose;
  EXPECT_LT(pose.center_of_mass.norm(), 1e-15);
  EXPECT_LT(pose.angular_velocity.cross(direction).norm(), 1e-9 * pose.angular_velocity.norm());
  EXPECT_GT(pose.angular_velocity.norm(), 0.1);
}

TEST_P(GuidedBody, OnAnAxleTurnsSteadilyAndSlowsDownByItsBrake) {
  const Vec3 direction = Vec3(1, 2, 2) / 3;
  for (const Real damping : {0.0, 0.02, 5.0}) {
    BodyDescription body = wheel(direction, damping);
    body.angular_velocity = 4 * direction;
    Simulation simulation = make_simulation(scene_of(GetParam(), {body}));
    const Real moment = moment_about(simulation.bodies()[0], direction);
    const Vec3 arm = simulation.bodies()[0].positions[0];
    const Real decay = damping / moment;
    advance_to(simulation, 0.5);
    const RigidPose pose = *simulation.bodies()[0].pose;
    const Real speed = 4 * std::exp(-decay * 0.5);
    EXPECT_LT((pose.angular_velocity - speed * direction).norm(), 1e-12 + 1e-9 * speed) << damping;
    EXPECT_LT(pose.center_of_mass.norm(), 1e-15);
    if (damping > 0) continue;
    const Quat turn(Eigen::AngleAxis<Real>(2, direction));
    EXPECT_LT((simulation.bodies()[0].positions[0] - turn * arm).norm(), 1e-4);
  }
}

TEST(GuidedBodyTorque, IsTheSumOfContactsAboutTheAxle) {
  BodyDescription load = plate("load", {0.1, 0, 0.19});
  load.orientation = Quat(std::sqrt(0.5), std::sqrt(0.5), 0, 0);
  BodyDescription own = plate("wheel", Vec3::Zero());
  own.axle = Axle{};
  load.shape = make_particles({Vec3::Zero()}, 0.1);
  Simulation simulation = make_simulation(scene_of(IntegratorId::velocity_verlet, {own, load}));
  // One particle above the end of the plate: overlap 0.01 m, force 5 N, arm 0.1 m.
  EXPECT_NEAR(simulation.diagnostics().axle_torque.value(), 5 * 0.1, 1e-12);
  own.axle.reset();
  simulation = make_simulation(scene_of(IntegratorId::velocity_verlet, {own, load}));
  EXPECT_FALSE(simulation.diagnostics().axle_torque.has_value());
}

TEST(GuidedBodyCommands, MoveAGuidedBodyWithoutAVelocity) {
  Scene scene = scene_of(IntegratorId::velocity_verlet, {driven({0, 0, 0}), wheel({0, 1, 0}, 0)});
  scene.bodies[1].position = {2, 0, 0};
  Simulation simulation = make_advanced(scene, 20);
  for (const std::size_t b : {0U, 1U}) {
    const BodyId id = simulation.bodies()[b].id;
    EXPECT_EQ(errors_of(simulation.move_body(id, {{5, 0, 1}, {}, Vec3(1, 0, 0)})),
              "not_allowed /velocity");
    ASSERT_TRUE(simulation.move_body(id, {{5, Real(b), 1}, {}, Vec3::Zero()}));
  }
  const Real time = simulation.time();
  simulation.advance(20);
  const Vec3 way = offset_at(simulation.time()) - offset_at(time);
  EXPECT_LT((simulation.bodies()[0].pose->center_of_mass - Vec3(5, 0, 1) - way).norm(), 1e-13);
  EXPECT_EQ(simulation.bodies()[1].pose->center_of_mass, Vec3(5, 1, 1));
}

TEST(GuidedBodySleep, NothingSleepsBesideADrivenBody) {
  Scene scene =
      scene_of(IntegratorId::velocity_verlet, {driven({0, 0, 0}), plate("still", {3, 0, 0})});
  scene.gravity = Vec3::Zero();
  scene.sleeping = Sleeping{0.01, 0.05};
  Simulation simulation = make_advanced(scene, 50);
  EXPECT_EQ(simulation.sleeping_body_count(), 0U);
  scene.bodies[0].motion.reset();
  simulation = make_simulation(scene);
  simulation.advance(50);
  EXPECT_EQ(simulation.sleeping_body_count(), 2U);
}

INSTANTIATE_TEST_SUITE_P(Integrators, GuidedBody, testing::ValuesIn(kIntegrators), NameOf());

}  // namespace
}  // namespace vat::test::guided_body_test
