#include <gtest/gtest.h>

#include "tests/core/support/resting_scenes.h"

// Conditions for sleep.

namespace vat::test::sleep_test {
namespace {

/// Islands are searched in every eighth check. A tick has one check.
constexpr int kTicksToSleep = 9;

TEST(Sleep, ABodyAtRestSleepsAfterItsTime) {
  Scene scene = make_resting_scene();
  scene.bodies = {make_crate("crate", {0, 0, kCrateRest + 0.1})};
  Simulation simulation = make_simulation(scene);
  Real rests_since = 0;
  while (simulation.time() < 2 && !is_asleep(simulation, "crate")) {
    if (velocity_of(simulation, 0, 26).norm() > scene.sleeping->speed) {
      rests_since = simulation.time();
    }
    simulation.advance(1);
  }
  EXPECT_GT(rests_since, 0.1);  // it fell
  EXPECT_GE(simulation.time() - rests_since, scene.sleeping->after);
  EXPECT_LE(simulation.time() - rests_since,
            scene.sleeping->after + kTicksToSleep * scene.numerics.tick);
  EXPECT_EQ(simulation.diagnostics().sleeping_bodies, 1U);
}

TEST(Sleep, SleepersKeepTheirPlacesAndTakeNoSteps) {
  Scene scene = make_resting_scene();
  scene.bodies = {make_crate("crate", 0.0), make_crate("other", 5.0)};
  Simulation simulation = make_simulation(scene);
  advance_to_sleep(simulation, "crate", 2);
  ASSERT_EQ(simulation.diagnostics().sleeping_bodies, 2U);
  const std::vector<Vec3> before(simulation.bodies()[1].positions.begin(),
                                 simulation.bodies()[1].positions.end());
  const Real time = simulation.time();
  const AdvanceReport report = simulation.advance(400);
  EXPECT_EQ(report.steps, 0U);
  EXPECT_EQ(report.force_evaluations, 0U);
  EXPECT_FALSE(report.failed);
  EXPECT_NEAR(simulation.time() - time, 400 * scene.numerics.step, 1e-12);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(position_of(simulation, 1, i), before[i]);
    EXPECT_EQ(velocity_of(simulation, 1, i), Vec3(Vec3::Zero()));
  }
}

TEST(Sleep, NotAboveTheSpeedLimits) {
  Scene scene = make_resting_scene();
  scene.gravity.setZero();
  scene.bodies = {make_crate("moves", {0, 0, 3}), make_crate("turns", {5, 0, 3})};
  scene.bodies[0].velocity = {0, 1.1e-3, 0};
  // The corners are 0.14 m from the axis.
  scene.bodies[1].angular_velocity = {0, 0, 1.1e-3 / 0.1414};
  Simulation simulation = make_advanced(scene, 960);
  EXPECT_FALSE(is_asleep(simulation, "moves"));
  EXPECT_FALSE(is_asleep(simulation, "turns"));
}

// A body that oscillates is slow in every fourth check, at its turning points.
TEST(Sleep, NotWhileSwinging) {
  Scene scene = make_resting_scene();
  scene.gravity.setZero();
  scene.vat.reset();
  const Real period = 8 * scene.numerics.tick;
  scene.central_field = CentralField{{0, 0, 0}, 2 * std::numbers::pi / period};
  scene.sleeping->speed = 0.05;
  scene.bodies = {make_marble("marble", {0.01, 0, 0})};
  Simulation simulation = make_simulation(scene);
  int slow = 0;
  for (int n = 0; n < 60; ++n) {
    slow += velocity_of(simulation, 0).norm() < scene.sleeping->speed ? 1 : 0;
    simulation.advance(4);
    ASSERT_FALSE(is_asleep(simulation, "marble"));
  }
  EXPECT_GE(slow, 13);
}

/// A body at rest that touches a body which a user moves back and forth.
TEST(Sleep, NotBesideMovingBodies) {
  Scene scene = make_resting_scene();
  scene.bodies = {make_crate("still", 0.0), make_marble("moving", {0, 0, 0.35}),
                  make_crate("far", 5.0)};
  Simulation simulation = make_simulation(scene);
  const BodyId moving = simulation.find_body("moving").value();
  ASSERT_TRUE(simulation.grab_start(1, moving, 0, {0.05, 0, 0.35}).ok());
  for (int n = 0; n < 120; ++n) {
    ASSERT_TRUE(simulation.grab_move(1, {n % 8 < 4 ? 0.05 : -0.05, 0, 0.35}).ok());
    simulation.advance(4);
    ASSERT_FALSE(is_asleep(simulation, "still"));
    ASSERT_FALSE(is_asleep(simulation, "moving"));
  }
  EXPECT_TRUE(is_asleep(simulation, "far"));
}

TEST(Sleep, NotWhileAUserHoldsOrPushes) {
  Scene scene = make_resting_scene();
  scene.bodies = {make_crate("held", 0.0), make_crate("pushed", 5.0)};
  Simulation simulation = make_simulation(scene);
  const BodyId held = simulation.find_body("held").value();
  ASSERT_TRUE(simulation.grab_start(1, held, 13, {0, 0, kCrateRest}).ok());
  // Friction holds the body: 0.5 m g is 13 N.
  ASSERT_TRUE(simulation.apply_force(simulation.find_body("pushed").value(), {1, 0, 0}, 2).ok());
  simulation.advance(470);
  EXPECT_FALSE(is_asleep(simulation, "held"));
  EXPECT_FALSE(is_asleep(simulation, "pushed"));
  ASSERT_TRUE(simulation.grab_end(1).ok());
  simulation.advance(200);
  EXPECT_TRUE(is_asleep(simulation, "held"));
  EXPECT_TRUE(is_asleep(simulation, "pushed"));
}

/// A permanently fixed obstacle does not join the bodies on it into an island.
TEST(Sleep, AnObstacleJoinsNothing) {
  Scene scene = make_resting_scene();
  BodyDescription ledge = make_body("ledge", BodyKind::rigid, "wood",
                                    make_particles(make_lattice(60, 3, 1, 0.1), 0.1), kRestRadius);
  ledge.position.z() = 1;
  ledge.fixed = true;
  scene.bodies = {ledge, make_crate("left", {-2.5, 0, 1 + kCrateRest + kRestRadius}),
                  make_marble("right", {2.5, 0, 1.5})};
  scene.materials.push_back(make_material("rubber"));
  scene.bodies[2].material = "rubber";
  scene.interfaces = {{{"wood", "rubber"}, scene.default_interface, {}}};
  scene.interfaces[0].constants.restitution = 1;  // it bounces forever
  Simulation simulation = make_advanced(scene, 480);
  EXPECT_TRUE(is_asleep(simulation, "left"));
  EXPECT_FALSE(is_asleep(simulation, "right"));
  EXPECT_FALSE(is_asleep(simulation, "ledge"));
  EXPECT_GT(position_of(simulation, 2).z(), 1 + kRestRadius);
}

TEST(Sleep, NotBeforeARelease) {
  Scene scene = make_resting_scene();
  scene.bodies = {make_crate("held", {0, 0, 2})};
  scene.bodies[0].release = 1;
  Simulation simulation = make_simulation(scene);
  for (int n = 0; n < 60; ++n) {
    simulation.advance(4);
    ASSERT_FALSE(is_asleep(simulation, "held"));
  }
  simulation.advance(48);
  // 0.2 s of free fall. The integration may differ by half the distance of each step.
  const Real fall = 9.81 * 0.2 * 0.2 / 2;
  EXPECT_NEAR(position_of(simulation, 0, 13).z(), 2 - fall, 9.81 * 0.2 * scene.numerics.step);
}

TEST(Sleep, NotBeforeMelting) {
  Scene scene = make_resting_scene();
  scene.materials.push_back(make_liquid("water", 1000, {100, 1, 0.2}));
  scene.default_interface = {1000, 10};
  BodyDescription ice = make_crate("ice", {0, 0, 3});
  ice.kind = BodyKind::deformable;
  ice.melting = Melting{"water", 2};
  scene.gravity.setZero();
  scene.bodies = {ice, make_crate("crate", {5, 0, 3})};
  Simulation simulation = make_advanced(scene, 470);
  EXPECT_FALSE(is_asleep(simulation, "ice"));
  EXPECT_TRUE(is_asleep(simulation, "crate"));
  EXPECT_TRUE(simulation.advance(20).bodies_changed);
  EXPECT_EQ(simulation.bodies()[0].kind, BodyKind::liquid);
  EXPECT_EQ(simulation.bodies().size(), 2U);
}

TEST(Sleep, NothingInAVatThatMovesOrWhileLiquidsSettleOrFlowIn) {
  Scene scene = make_resting_scene();
  scene.bodies = {make_crate("crate", 0.0)};
  Scene slides = scene;
  slides.vat->motion = SlideMotion{{1, 0, 0}, 1e-6, 100};
  Scene belt = scene;
  belt.vat->walls[4].velocity = {1e-6, 0, 0};
  Scene settles = scene;
  settles.settling = Settling{1, 1.5};
  Scene flows = scene;
  flows.materials.push_back(make_liquid("water", 1000, {10, 1, 0.2}));
  flows.bodies.push_back(
      make_body("water", BodyKind::liquid, "water", make_particles({{5, 0, 3}}, 1), kRestRadius));
  flows.bodies.back().spacing = 0.1;
  flows.emitters = {{.name = "tap",
                     .body = "water",
                     .position = {5, 0, 5},
                     .radius = 0.1,
                     .speed = 1,
                     .from = 5,
                     .until = 6,
                     .most_particles = 100}};
  for (const Scene& driven : {slides, belt, settles, flows}) {
    Simulation simulation = make_advanced(driven, 350);
    EXPECT_FALSE(is_asleep(simulation, "crate"));
  }
  Simulation simulation = make_advanced(settles, 480);
  EXPECT_TRUE(is_asleep(simulation, "crate"));
  flows.emitters[0].open = false;
  Simulation closed = make_advanced(flows, 350);
  EXPECT_TRUE(is_asleep(closed, "crate"));
  ASSERT_TRUE(closed.set_emitter("tap", true).ok());
  EXPECT_FALSE(is_asleep(closed, "crate"));
}

TEST(Sleep, DistantBodiesAreNotAffectedBySleepers) {
  Scene scene = make_resting_scene();
  scene.default_interface = {5000, 3, 0.3};  // forces that are kept between steps
  scene.numerics.step = 1e-3;
  scene.numerics.tick = 0.01;
  scene.bodies = {make_crate("first", -5.0), make_marble("ball", {0.3, 0, 2}),
                  make_crate("last", 5.0)};
  scene.bodies[1].velocity = {0.5, 0.25, 0};
  scene.sleeping->speed = 0.01;  // the crates first sink slightly
  Scene alone = scene;
  alone.bodies = {scene.bodies[1]};
  alone.sleeping.reset();
  Simulation a = make_simulation(scene);
  Simulation b = make_simulation(alone);
  bool slept = false;
  for (int n = 0; n < 200; ++n) {
    a.advance(10);
    b.advance(10);
    slept = slept || a.diagnostics().sleeping_bodies == 2;
    ASSERT_EQ(position_of(a, 1), position_of(b, 0)) << n;
    ASSERT_EQ(velocity_of(a, 1), velocity_of(b, 0)) << n;
  }
  EXPECT_TRUE(slept);
  EXPECT_FALSE(is_asleep(a, "ball"));
}

}  // namespace
}  // namespace vat::test::sleep_test
