#include "core/guard/enforce_walls.h"

#include <gtest/gtest.h>

#include <random>

#include "core/state/rigid_motion.h"
#include "tests/support/force_probe.h"
#include "tests/support/name_of.h"
#include "tests/support/same_bits.h"
#include "tests/support/scenes.h"
#include "tests/support/shaken_vat.h"

/// The planes behind the walls' springs.
namespace vat::test::hold_inside_test {
namespace {

constexpr Real kStep = 1e-3;
constexpr Real kRadius = 0.05;

/// A vat around the origin without wall springs. Its coordinates are not exact in binary.
Scene make_soft_vat(IntegratorId integrator = IntegratorId::velocity_verlet) {
  Scene scene = make_scene(integrator, kStep, {make_material("m")});
  scene.interfaces = {{{"m", kVatMaterial}, {0, 0}, {}}};
  scene.vat = Vat{{-0.9, -1.1, -0.7}, {1.3, 0.9, 1.7}, true, {}};
  return scene;
}

BodyDescription make_grain(const Vec3& position, const Vec3& velocity) {
  BodyDescription body =
      make_body("grain", BodyKind::deformable, "m", make_particles({Vec3::Zero()}, 0.1), kRadius);
  body.position = position;
  body.velocity = velocity;
  return body;
}

/// A brick with three different moments of inertia.
BodyDescription make_brick(const Vec3& position, const Vec3& velocity, const Vec3& spin) {
  BodyDescription body = make_body("brick", BodyKind::rigid, "m",
                                   make_particles(make_lattice(4, 3, 2, 0.1), 0.2), kRadius);
  body.position = position;
  body.velocity = velocity;
  body.angular_velocity = spin;
  return body;
}

/// A compiled scene that the tests put into any configuration.
struct Trial {
  explicit Trial(const Scene& scene)
      : model(compile_scene(scene)),
        bounds(guard_bounds(*model)),
        before(initial_state(*model).now),
        now(before) {}

  std::uint64_t hold(Real time = 0, TaskRunner* runner = nullptr) {
    return enforce_walls(*model, bounds, {time, 0}, before, runner, now);
  }

  std::shared_ptr<const Model> model;
  GuardBounds bounds;
  Configuration before;
  Configuration now;
};

Real rigid_energy(const Trial& trial, const Vec3& frame_velocity) {
  const RigidModel& rigid = trial.model->rigid_bodies[0];
  const RigidState& state = trial.now.rigid[0];
  const Vec3 velocity = rigid.inverse_mass * state.momentum - frame_velocity;
  const Vec3 omega = angular_velocity(rigid, state.orientation, state.angular_momentum);
  return velocity.squaredNorm() / rigid.inverse_mass / 2 + omega.dot(state.angular_momentum) / 2;
}

class HoldInside : public testing::TestWithParam<IntegratorId> {};

TEST_P(HoldInside, AGrainStopsAtThePlaneAndKeepsItsTangentialVelocity) {
  for (int wall = 0; wall < kWallCount; ++wall) {
    Scene scene = make_soft_vat(GetParam());
    const Vec3 along(wall / 2 == 0 ? 0 : 0.3, wall / 2 == 1 ? 0 : -0.2, wall / 2 == 2 ? 0 : 0.1);
    scene.bodies = {make_grain({0.1, 0, 0.2}, along - 20 * wall_normal(wall))};
    Simulation simulation = make_simulation(scene);
    EXPECT_EQ(simulation.advance(200).wall_stops, 1U) << wall;
    const int axis = wall / 2;
    const Real plane = (wall % 2 == 0 ? scene.vat->min : scene.vat->max)[axis];
    EXPECT_EQ(position_of(simulation, 0)[axis], plane) << wall;
    EXPECT_EQ(velocity_of(simulation, 0), along) << wall;
    EXPECT_EQ(simulation.diagnostics().particles_outside, 0U) << wall;
  }
}

// In half a step, a particle at 20 m/s moves far beyond the plane. A spring would then push with
// the full depth.
TEST_P(HoldInside, TheNextStepHasTheForcesAtThePlane) {
  constexpr Real kStiffness = 100;
  constexpr Real kInset = 1e-12;  // no scene starts exactly on the plane
  Scene scene = make_soft_vat(GetParam());
  scene.interfaces[0].constants.stiffness = kStiffness;
  scene.bodies = {make_grain({0, 0, -0.7 + 0.007}, {0, 0, -20})};
  Simulation simulation = make_simulation(scene);
  ASSERT_EQ(simulation.advance(1).wall_stops, 1U);
  scene.bodies = {make_grain({0, 0, -0.7 + kInset}, {0, 0, 0})};
  const Simulation stopped = make_advanced(scene, 1);
  simulation.advance(1);
  EXPECT_LT((position_of(simulation, 0) - position_of(stopped, 0)).norm(), 2 * kInset);
  EXPECT_LT((velocity_of(simulation, 0) - velocity_of(stopped, 0)).norm(), 2 * kInset);
}

TEST_P(HoldInside, FiftyGravitiesPressNothingThroughTheSoftestWalls) {
  for (const StepControl control :
       {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
    const bool is_verlet = GetParam() == IntegratorId::velocity_verlet;
    if (control == StepControl::local && !is_verlet) continue;
    Scene scene = make_soft_vat(GetParam());
    scene.numerics.control = control;
    scene.interfaces[0].constants.stiffness = 1e-3;
    scene.gravity = {300, -200, -350};
    scene.vat->motion = SlideMotion{{1, 0.5, 0}, 0.3, 0.2};
    scene.bodies = {make_grain({0.5, 0.5, 0.5}, {0, 0, 0}),
                    make_brick({-0.1, 0.2, 0.3}, {1, 2, 3}, {5, -7, 3})};
    Simulation simulation = make_simulation(scene);
    std::uint64_t stops = 0;
    for (int step = 0; step < 600; ++step) {
      const AdvanceReport report = simulation.advance(1);
      ASSERT_FALSE(report.failed) << to_string(control) << " at step " << step;
      stops += report.wall_stops;
      ASSERT_EQ(simulation.diagnostics().particles_outside, 0U)
          << to_string(control) << " after step " << step;
    }
    EXPECT_GT(stops, 600U) << to_string(control);
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, HoldInside, testing::ValuesIn(kIntegrators), NameOf());

TEST(HoldInsideGrain, TakesTheSpeedOfAWallThatMoves) {
  Scene scene = make_soft_vat();
  scene.vat->motion = SlideMotion{{1, 0, 0}, 0.4, 1};
  scene.bodies = {make_grain({0, 0.3, 0.1}, {0, 0, 0})};
  for (const Real time : {0.1, 0.3, 0.55, 0.9, 12345.6}) {
    Trial trial(scene);
    const VatMotion motion = vat_motion(*scene.vat, time);
    trial.now.position[0].x() = scene.vat->min.x() + motion.offset.x() - 0.01;
    trial.now.velocity[0] = {motion.velocity.x() - 3, 1, 2};
    EXPECT_EQ(trial.hold(time), 1U);
    EXPECT_GE(wall_distance(*scene.vat, motion, 0, trial.now.position[0]), 0) << time;
    EXPECT_LT(wall_distance(*scene.vat, motion, 0, trial.now.position[0]), 1e-15) << time;
    EXPECT_EQ(trial.now.velocity[0], Vec3(motion.velocity.x(), 1, 2)) << time;
    trial.now.position[0].x() -= 0.01;  // a particle that returns by itself keeps its velocity
    trial.now.velocity[0].x() = motion.velocity.x() + 1;
    EXPECT_EQ(trial.hold(time), 1U);
    EXPECT_EQ(trial.now.velocity[0].x(), motion.velocity.x() + 1) << time;
  }
}

TEST(HoldInsideGrain, AFixedOneKeepsItsPlace) {
  Scene scene = make_soft_vat();
  scene.bodies = {make_grain({0, 0, 0}, {0, 0, 0})};
  std::get<ParticleShape>(scene.bodies[0].shape).fixed = {0};
  Trial trial(scene);
  trial.now.position[0] = {0, 0, -5};
  EXPECT_EQ(trial.hold(), 0U);
  EXPECT_EQ(trial.now.position[0], Vec3(0, 0, -5));
}

TEST(HoldInsideGrain, DisabledWallsDoNotHold) {
  Scene scene = make_soft_vat();
  scene.forces.walls = false;
  scene.bodies = {make_grain({0, 0, 0}, {0, 0, -20})};
  Simulation simulation = make_simulation(scene);
  EXPECT_EQ(simulation.advance(60).wall_stops, 0U);
  EXPECT_LT(position_of(simulation, 0).z(), -1);
}

/// Poses and motions in all directions, near every wall and corner of a moving vat.
TEST(HoldInsideBody, AnImpulseAlongTheNormalsPutsItBackAndAddsNoEnergy) {
  Scene scene = make_soft_vat();
  scene.vat->motion = SlideMotion{{1, 2, -1}, 0.4, 1};
  scene.bodies = {make_brick({0, 0, 0}, {0, 0, 0}, {0, 0, 0})};
  std::mt19937 random(7);
  std::uniform_real_distribution<Real> uniform(-1, 1);
  const auto vector = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  int stopped = 0;
  for (int n = 0; n < 2000; ++n) {
    Trial trial(scene);
    const VatMotion motion = vat_motion(*scene.vat, 0.01 * n);
    RigidState& state = trial.now.rigid[0];
    state = {
        motion.offset + 1.6 * vector(),
        Quat(Eigen::Vector4d(uniform(random), uniform(random), uniform(random), 1)).normalized(),
        30 * vector(), vector()};
    const RigidState free = state;
    const Real energy = rigid_energy(trial, motion.velocity);
    const std::uint64_t stops = trial.hold(0.01 * n);
    pose_rigid_body(*trial.model, trial.model->rigid_bodies[0], state, trial.now);
    int touched = 0;
    for (const int wall : trial.model->walls) {
      for (const Vec3& position : trial.now.position) {
        ASSERT_GE(wall_distance(*scene.vat, motion, wall, position), 0) << n;
      }
      const Real push = (state.momentum - free.momentum).dot(wall_normal(wall));
      touched += push > 0 ? 1 : 0;
      const bool is_moved = state.center_of_mass[wall / 2] != free.center_of_mass[wall / 2];
      if (!is_moved) {
        EXPECT_EQ(push, 0) << n;
      }
    }
    EXPECT_LE(rigid_energy(trial, motion.velocity), energy * (1 + 1e-14)) << n;
    // A single impulse along a normal has no torque about that normal.
    if (touched == 1) {
      const Vec3 normal = (state.momentum - free.momentum).normalized();
      EXPECT_NEAR((state.angular_momentum - free.angular_momentum).dot(normal), 0, 1e-13) << n;
    }
    if (stops == 0) {
      EXPECT_EQ(state.center_of_mass, free.center_of_mass);
    }
    stopped += static_cast<int>(stops);
  }
  EXPECT_GT(stopped, 1000);
}

TEST(HoldInsideBody, AFlatFaceStopsWithoutTurning) {
  Scene scene = make_soft_vat();
  scene.bodies = {make_brick({0.2, 0.1, 0}, {1, 0, -4}, {0, 0, 0})};
  Simulation simulation = make_simulation(scene);
  EXPECT_EQ(simulation.advance(200).wall_stops, 1U);
  const RigidPose pose = *simulation.bodies()[0].pose;
  EXPECT_NEAR(pose.center_of_mass.z(), -0.7 + 0.05, 1e-15);  // two layers, 0.1 m apart
  EXPECT_LT((pose.velocity - Vec3(1, 0, 0)).norm(), 1e-14);
  EXPECT_LT(pose.angular_velocity.norm(), 1e-12);
}

TEST(HoldInsideBody, OneThatTurnedTooFarToFitTurnsBack) {
  Scene scene = make_soft_vat();
  scene.vat = Vat{{-1, -0.1, -0.1}, {1, 0.1, 0.1}, true, {}};
  scene.bodies = {make_body("rod", BodyKind::rigid, "m",
                            make_particles(make_lattice(11, 1, 1, 0.1), 0.1), kRadius)};
  Trial trial(scene);
  trial.now.rigid[0].orientation = Quat(Eigen::AngleAxis<Real>(0.5, Vec3::UnitY()));
  trial.now.rigid[0].angular_momentum = {0, 1, 0};
  trial.now.rigid[0].center_of_mass.z() = 0.3;
  EXPECT_EQ(trial.hold(), 1U);
  EXPECT_EQ(trial.now.rigid[0].orientation.coeffs(), trial.before.rigid[0].orientation.coeffs());
  EXPECT_EQ(trial.now.rigid[0].angular_momentum, Vec3(Vec3::Zero()));
  EXPECT_EQ(trial.hold(), 0U);
}

TEST(HoldInsideBody, OneThatIsHeldPassesUntilItIsReleased) {
  Scene scene = make_soft_vat();
  scene.bodies = {make_brick({0, 0, 0}, {0, 0, -10}, {0, 0, 0})};
  scene.bodies[0].release = 0.1;
  Simulation simulation = make_simulation(scene);
  EXPECT_EQ(simulation.advance(100).wall_stops, 0U);
  EXPECT_EQ(simulation.diagnostics().particles_outside, 24U);
  EXPECT_EQ(simulation.advance(1).wall_stops, 1U);
  EXPECT_EQ(simulation.diagnostics().particles_outside, 0U);
}

TEST(HoldInsideBits, AreTheSameForAnyThreadsAndSnapshots) {
  Scene scene = make_shaken_vat(IntegratorId::velocity_verlet);
  scene.gravity = {60, -90, -500};
  scene.interfaces = {{{"a", kVatMaterial}, {1, 0}, {}}, {{"b", kVatMaterial}, {1, 0}, {}}};
  Simulation simulation = make_simulation(scene);
  EXPECT_GT(simulation.advance(60).wall_stops, 0U);
  expect_same_bits(scene, 60, 20);
}

}  // namespace
}  // namespace vat::test::hold_inside_test
