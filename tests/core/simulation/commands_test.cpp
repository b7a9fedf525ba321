#include <gtest/gtest.h>

#include <limits>

#include "core/limits.h"
#include "tests/support/errors.h"
#include "tests/support/shaken_vat.h"

// Commands take effect at the current time. A failed command changes nothing.

namespace vat::test::commands_test {
namespace {

constexpr Real kStep = 1e-3;
constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();

Scene make_block_of(BodyKind kind) {
  Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, kStep);
  scene.bodies = {make_block("block", kind, "a", 3, {1, 2, 3}, {1, 0, 0})};
  return scene;
}

TEST(SetGravity, ActsFromThePresentTime) {
  for (const BodyKind kind : kBodyKinds) {
    Simulation simulation = make_simulation(make_block_of(kind));
    const Vec3 start = simulation.diagnostics().bodies[0].center_of_mass;
    advance_to(simulation, 0.1);
    ASSERT_TRUE(simulation.set_gravity({0, 2, -10}).ok());
    advance_to(simulation, 0.3);
    ASSERT_TRUE(simulation.set_gravity(Vec3::Zero()).ok());
    advance_to(simulation, 0.4);
    const Vec3 end = simulation.diagnostics().bodies[0].center_of_mass;
    // 0.2 s under gravity, then 0.1 s at the reached speed.
    const Vec3 expected = start + 0.4 * Vec3(1, 0, 0) + (0.02 + 0.2 * 0.1) * Vec3(0, 2, -10);
    EXPECT_LT((end - expected).norm(), 1e-12) << to_string(kind);
  }
}

TEST(SetGravity, ShowsInTheSceneAndRefusesBadValues) {
  Simulation simulation = make_simulation(make_block_of(BodyKind::rigid));
  ASSERT_TRUE(simulation.set_gravity({1, 2, 3}).ok());
  for (const Vec3& bad : {Vec3(0, 0, kNan), Vec3(0, 2 * kMaxGravity, 0)}) {
    EXPECT_EQ(errors_of(simulation.set_gravity(bad)), "out_of_range /gravity");
  }
  EXPECT_EQ(simulation.scene().gravity, Vec3(1, 2, 3));
}

TEST(ApplyForce, RefusesBadValues) {
  Simulation simulation = make_simulation(make_block_of(BodyKind::rigid));
  const BodyId id = simulation.bodies()[0].id;
  const Vec3 force(1, 0, 0);
  EXPECT_EQ(errors_of(simulation.apply_force(id + 1, force, 1)), "no_such_body /body");
  EXPECT_EQ(errors_of(simulation.apply_force(id, {0, kNan, 0}, 1)), "out_of_range /force");
  for (const Real bad : {0.0, -1.0, kNan, 2 * kMaxForceTime}) {
    EXPECT_EQ(errors_of(simulation.apply_force(id, force, bad)), "out_of_range /duration");
  }
  for (std::size_t n = 0; n < kMaxAppliedForces; ++n) {
    ASSERT_TRUE(simulation.apply_force(id, force, kStep).ok());
  }
  EXPECT_EQ(errors_of(simulation.apply_force(id, force, kStep)), "limit_reached ");
  simulation.advance(1);  // expired forces free their slots
  EXPECT_TRUE(simulation.apply_force(id, force, kStep).ok());
}

TEST(AddBody, AppearsWithItsStateAndMovesNothingElse) {
  for (const BodyKind kind : kBodyKinds) {
    Simulation simulation = make_advanced(make_shaken_vat(IntegratorId::velocity_verlet), 20);
    const Diagnostics before = simulation.diagnostics();
    BodyDescription body = make_block("newcomer", kind, "a", 2, {0, 0, 0.7}, {0.5, 0, 0});
    const Result<BodyId> id = simulation.add_body(body);
    ASSERT_TRUE(id.ok());
    EXPECT_EQ(simulation.time(), before.time);
    const Diagnostics after = simulation.diagnostics();
    ASSERT_EQ(after.bodies.size(), 4U);
    for (std::size_t b = 0; b < 3; ++b) {
      EXPECT_NE(after.bodies[b].id, id.value());
      EXPECT_EQ(after.bodies[b].center_of_mass, before.bodies[b].center_of_mass);
      EXPECT_EQ(after.bodies[b].linear_momentum, before.bodies[b].linear_momentum);
      EXPECT_EQ(after.bodies[b].angular_momentum, before.bodies[b].angular_momentum);
    }
    EXPECT_EQ(after.bodies[3].name, "newcomer");
    EXPECT_LT((after.bodies[3].center_of_mass - Vec3(0, 0, 0.7)).norm(), 1e-15);
    EXPECT_LT((after.bodies[3].linear_momentum - Vec3(0.5, 0, 0)).norm(), 1e-15);
    EXPECT_EQ(simulation.find_body("newcomer"), id.value());
    EXPECT_EQ(simulation.scene().bodies.size(), 4U);
  }
}

// A body that a command adds at time 0 gives the same bits as a body of the scene.
TEST(AddBody, IsAsIfTheSceneHadIt) {
  const Scene whole = make_shaken_vat(IntegratorId::velocity_verlet);
  Scene empty = whole;
  empty.bodies.clear();
  Simulation added = make_simulation(empty);
  for (const BodyDescription& body : whole.bodies) ASSERT_TRUE(added.add_body(body).ok());
  Simulation loaded = make_simulation(whole);
  added.advance(30);
  loaded.advance(30);
  EXPECT_EQ(added.state_hash(), loaded.state_hash());
}

TEST(AddBody, RefusesBadBodies) {
  Simulation simulation = make_simulation(make_shaken_vat(IntegratorId::velocity_verlet));
  const std::uint64_t hash = simulation.state_hash();
  const BodyDescription good =
      make_block("newcomer", BodyKind::rigid, "a", 2, {0, 0, 0.7}, Vec3::Zero());
  BodyDescription bad = good;
  bad.name = "pool";
  EXPECT_EQ(errors_of(simulation.add_body(bad)), "duplicate /body/name");
  bad = good;
  bad.position = {0, 0, 5};
  EXPECT_EQ(errors_of(simulation.add_body(bad)), "outside_vat /body");
  EXPECT_EQ(simulation.state_hash(), hash);
  EXPECT_EQ(simulation.bodies().size(), 3U);
}

TEST(RemoveBody, DoesNotMoveOthers) {
  for (const char* name : {"pool", "jelly", "crate"}) {
    Simulation simulation = make_advanced(make_shaken_vat(IntegratorId::velocity_verlet), 20);
    const std::vector<BodyDiagnostics> before = simulation.diagnostics().bodies;
    ASSERT_TRUE(simulation.remove_body(simulation.find_body(name).value()).ok());
    EXPECT_FALSE(simulation.find_body(name).has_value());
    const std::vector<BodyDiagnostics> after = simulation.diagnostics().bodies;
    ASSERT_EQ(after.size(), 2U);
    for (const BodyDiagnostics& body : after) {
      const auto old = std::ranges::find(before, body.id, &BodyDiagnostics::id);
      ASSERT_NE(old, before.end());
      EXPECT_EQ(old->name, body.name);
      EXPECT_EQ(old->center_of_mass, body.center_of_mass);
      EXPECT_EQ(old->linear_momentum, body.linear_momentum);
      EXPECT_EQ(old->angular_momentum, body.angular_momentum);
    }
    EXPECT_TRUE(simulation.advance(20).events.empty());
  }
}

TEST(RemoveBody, EndsItsInteractionsAndDoesNotReuseItsId) {
  Simulation simulation = make_simulation(make_shaken_vat(IntegratorId::velocity_verlet));
  const BodyId id = simulation.find_body("crate").value();  // the largest id so far
  ASSERT_TRUE(simulation.grab_start(1, id, 0, Vec3::Zero()).ok());
  ASSERT_TRUE(simulation.apply_force(id, {1, 0, 0}, 1).ok());
  ASSERT_TRUE(simulation.remove_body(id).ok());
  EXPECT_EQ(errors_of(simulation.remove_body(id)), "no_such_body /body");
  EXPECT_EQ(errors_of(simulation.grab_move(1, Vec3::Zero())), "no_such_grab /grab");
  EXPECT_TRUE(simulation.advance(5).events.empty());
  const BodyDescription again =
      make_block("crate", BodyKind::rigid, "b", 2, {0, 0, 0.7}, Vec3::Zero());
  EXPECT_GT(simulation.add_body(again).value(), id);
}

TEST(RemoveBody, KeepsForcesOnTheOthers) {
  Scene scene = make_block_of(BodyKind::rigid);
  scene.bodies.insert(scene.bodies.begin(),
                      make_block("first", BodyKind::rigid, "a", 2, {9, 0, 0}, Vec3::Zero()));
  Simulation simulation = make_simulation(scene);
  const BodyDiagnostics before = simulation.diagnostics().bodies[1];
  ASSERT_TRUE(simulation.apply_force(before.id, {0, 4, 0}, 1).ok());
  ASSERT_TRUE(simulation.remove_body(simulation.find_body("first").value()).ok());
  simulation.advance(100);
  const BodyDiagnostics after = simulation.diagnostics().bodies[0];
  EXPECT_LT((after.linear_momentum - before.linear_momentum - Vec3(0, 0.4, 0)).norm(), 1e-12);
}

/// Two particles at rest whose overlap is half of their threshold of 0.05 m.
Scene make_pair() {
  Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, kStep);
  scene.default_interface = {0, 0};
  scene.bodies = {make_block("one", BodyKind::rigid, "a", 1, {0, 0, 0}, Vec3::Zero()),
                  make_block("two", BodyKind::rigid, "b", 1, {0.025, 0, 0}, Vec3::Zero())};
  for (BodyDescription& body : scene.bodies) body.angular_velocity.setZero();
  return scene;
}

/// Returns the speed of the second particle after one step of contact.
Real speed_of_two(const Simulation& simulation) {
  return velocity_of(simulation, 1).x();
}

TEST(SetInterface, AddsOneAndReplacesItInEitherOrder) {
  Simulation simulation = make_advanced(make_pair(), 1);
  EXPECT_EQ(speed_of_two(simulation), 0);
  ASSERT_TRUE(simulation.set_interface({{"a", "b"}, {800, 0}, {}}).ok());
  const Snapshot touching = simulation.snapshot();
  simulation.advance(1);
  const Real speed = speed_of_two(simulation);
  EXPECT_NEAR(speed, 800 * 0.025 / 0.125 * kStep,
              0.01 * speed);  // slightly less, since the overlap decreases
  simulation.restore(touching);
  ASSERT_TRUE(simulation.set_interface({{"b", "a"}, {1600, 0}, {}}).ok());
  EXPECT_EQ(simulation.scene().interfaces.size(), 1U);
  simulation.advance(1);
  EXPECT_NEAR(speed_of_two(simulation), 2 * speed, 0.02 * speed);
}

TEST(SetInterface, RefusesBadOnes) {
  Simulation simulation = make_simulation(make_pair());
  EXPECT_EQ(errors_of(simulation.set_interface({{"a", "absent"}, {1, 0}, {}})),
            "unknown_name /interface/materials/1");
  EXPECT_EQ(errors_of(simulation.set_interface({{"a", "b"}, {-1, kNan}, -3.0})),
            "out_of_range /interface/stiffness\nout_of_range /interface/damping\n"
            "out_of_range /interface/threshold");
  EXPECT_TRUE(simulation.scene().interfaces.empty());
}

}  // namespace
}  // namespace vat::test::commands_test
