// A vat that users move: its motion, and the effect on its contents.

#include <gtest/gtest.h>

#include <cmath>

#include "core/laws/vat_motion.h"
#include "core/limits.h"
#include "tests/support/saved_bits.h"
#include "tests/support/scenes.h"

namespace vat::test::vat_by_hand_test {
namespace {

constexpr Real kV = kMaxHandSpeed;
constexpr Real kA = kMaxHandAcceleration;

/// A motion along x.
HandMotion to(Real target, Real offset = 0, Real velocity = 0, Real start = 0) {
  return {start, {offset, 0, 0}, {velocity, 0, 0}, {target, 0, 0}};
}

/// Returns the first time at rest, by bisection. The vat stays at rest afterwards.
Real end_of(const HandMotion& hand) {
  Real moving = hand.start;
  Real resting = hand.start + 1000;
  while (resting - moving > 1e-9) {
    const Real middle = (moving + resting) / 2;
    (is_moving(hand, middle) ? moving : resting) = middle;
  }
  return resting - hand.start;
}

TEST(HandMotion, TakesTheLeastTimeFromRestToRest) {
  EXPECT_NEAR(end_of(to(0.1)), 2 * std::sqrt(0.1 / kA), 1e-8);  // full speed is not reached
  EXPECT_NEAR(end_of(to(3)), 3 / kV + kV / kA, 1e-8);           // full speed for part of the time
  EXPECT_NEAR(end_of(to(-3)), 3 / kV + kV / kA, 1e-8);
  EXPECT_NEAR(end_of(to(0.1, 0, 1)), 1 / kA, 1e-8);  // braking only
  EXPECT_NEAR(end_of(to(0, 0, 1)), (1 + std::sqrt(2)) / kA,
              1e-8);  // out and back, starting at 1 m/s
  EXPECT_FALSE(is_moving(to(0.3, 0.3), 0));
}

TEST(HandMotion, IsSmoothWithinItsBoundsAndEndsAtTheTarget) {
  for (const Real offset : {0.0, 0.4, -2.0}) {
    for (const Real velocity : {0.0, 0.3, -1.0, 1.0}) {
      for (const Real target : {0.0, 0.05, -0.3, 2.5}) {
        SCOPED_TRACE(testing::Message() << offset << ' ' << velocity << ' ' << target);
        const HandMotion hand = to(target, offset, velocity, 7);
        constexpr Real kStep = 1e-4;
        VatMotion before = hand_motion(hand, 7);
        EXPECT_NEAR(before.offset.x(), offset, 1e-15);
        EXPECT_NEAR(before.velocity.x(), velocity, 1e-15);
        for (Real time = 7 + kStep; is_moving(hand, time - kStep); time += kStep) {
          const VatMotion now = hand_motion(hand, time);
          EXPECT_LE(std::abs(now.velocity.x()), kV + 1e-12);
          EXPECT_LE(std::abs(now.acceleration.x()), kA);
          // The error of the trapezoidal rule if the acceleration changes within the step.
          ASSERT_NEAR(now.offset.x() - before.offset.x(),
                      kStep / 2 * (now.velocity.x() + before.velocity.x()), kA * kStep * kStep);
          ASSERT_LE(std::abs(now.velocity.x() - before.velocity.x()), kA * kStep * (1 + 1e-6));
          before = now;
        }
        const VatMotion end = hand_motion(hand, 7 + end_of(hand) + 1e-6);
        EXPECT_NEAR(end.offset.x(), target, 1e-15);
        EXPECT_EQ(end.velocity.x(), 0);
        EXPECT_EQ(end.acceleration.x(), 0);
      }
    }
  }
}

TEST(HandMotion, IsSmoothAtAChangeOfTheTarget) {
  const HandMotion first = to(2);
  const VatMotion then = hand_motion(first, 0.3);
  const HandMotion second = to(-1, then.offset.x(), then.velocity.x(), 0.3);
  EXPECT_EQ(hand_motion(second, 0.3).offset, then.offset);
  EXPECT_EQ(hand_motion(second, 0.3).velocity, then.velocity);
  EXPECT_EQ(hand_motion(second, 0.29).offset, then.offset) << "a motion starts at its start time";
}

/// A ball of one particle that hits the wall x_max of a vat with floor friction.
Scene ball_in_vat(IntegratorId integrator, StepControl control) {
  Scene scene = make_scene(integrator, 1e-4);
  scene.numerics.control = control;
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_material("stone")};
  scene.default_interface = {1e4, 10};
  scene.default_interface.friction = 0.1;
  scene.vat = Vat{{-1, -1, 0}, {1, 1, 2}, false, {}};
  BodyDescription ball = make_body("ball", BodyKind::rigid, "stone",
                                   make_particles(make_lattice(2, 2, 2, 0.1), 0.5), 0.05);
  ball.position = {0.8, 0, 0.0995};
  scene.bodies = {ball};
  return scene;
}

struct HandCase {
  IntegratorId integrator;
  StepControl control;
};

class VatByHand : public testing::TestWithParam<HandCase> {
 protected:
  Scene scene() const { return ball_in_vat(GetParam().integrator, GetParam().control); }
};

// A vat at constant speed and a vat at rest give the same motion of their contents.
TEST_P(VatByHand, AtFullSpeedIsAsOneAtRest) {
  Simulation resting = make_simulation(scene());
  const BodyId ball = resting.bodies()[0].id;
  const Vec3 start = resting.find_body(ball)->pose->center_of_mass;
  ASSERT_TRUE(resting.move_body(ball, {start, Quat::Identity(), Vec3(2, 0, 0)}).ok());
  advance_to(resting, 0.5);

  Simulation moving = make_simulation(scene());
  ASSERT_TRUE(moving.move_vat({1.9, 0, 0}).ok());
  advance_to(moving, 0.3);  // at full speed after 0.2 s, for 1.7 s
  const Vec3 speed(kV, 0, 0);
  const Vec3 offset = moving.vat_offset();
  ASSERT_NEAR(offset.x(), kV * kV / kA / 2 + 0.1 * kV, 1e-12);
  ASSERT_TRUE(
      moving.move_body(ball, {start + offset, Quat::Identity(), Vec3(2, 0, 0) + speed}).ok());
  advance_to(moving, 0.8);

  const RigidPose at_rest = *resting.find_body(ball)->pose;
  const RigidPose seen = *moving.find_body(ball)->pose;
  ASSERT_LT(at_rest.velocity.x(), -0.5) << "the ball has bounced";
  // Tolerance for rounding. Variable steps have a relative error of one hundredth.
  const Real tolerance = GetParam().control == StepControl::fixed ? 1e-9 : 0.01;
  EXPECT_LT((seen.center_of_mass - moving.vat_offset() - at_rest.center_of_mass).norm(), tolerance);
  EXPECT_LT((seen.velocity - speed - at_rest.velocity).norm(), 10 * tolerance);
}

INSTANTIATE_TEST_SUITE_P(
    Steps, VatByHand,
    testing::Values(HandCase{IntegratorId::velocity_verlet, StepControl::fixed},
                    HandCase{IntegratorId::runge_kutta_4, StepControl::fixed},
                    HandCase{IntegratorId::velocity_verlet, StepControl::adaptive}),
    [](const auto& test) {
      return std::string(to_string(test.param.integrator)) + "_" + to_string(test.param.control);
    });

Scene plain() {
  return ball_in_vat(IntegratorId::velocity_verlet, StepControl::fixed);
}

TEST(MovedVat, ContinuesFromItsBytesWithTheSameBits) {
  Simulation simulation = make_simulation(plain());
  Simulation unmoved = make_advanced(plain(), 1000);
  ASSERT_TRUE(simulation.move_vat({0.5, 0.1, 0}).ok());
  simulation.advance(1000);
  EXPECT_EQ(simulation.snapshot().to_bytes().size(),
            unmoved.snapshot().to_bytes().size() + 10 * sizeof(Real));
  expect_goes_on(simulation, 7000);
  EXPECT_EQ(simulation.vat_offset(), Vec3(0.5, 0.1, 0));
}

TEST(MovedVat, HasAStateOfItsOwn) {
  Simulation simulation = make_simulation(plain());
  const Snapshot start = simulation.snapshot();
  const std::uint64_t hash = simulation.state_hash();
  ASSERT_TRUE(simulation.move_vat(Vec3::Zero()).ok());
  EXPECT_EQ(simulation.state_hash(), hash) << "the vat is already at its target";
  ASSERT_TRUE(simulation.move_vat({0.1, 0, 0}).ok());
  const std::uint64_t moved = simulation.state_hash();
  EXPECT_NE(moved, hash);
  ASSERT_TRUE(simulation.move_vat({0.1, 0, 0}).ok());
  EXPECT_EQ(simulation.state_hash(), moved) << "the vat already moves to its target";
  ASSERT_TRUE(simulation.move_vat({0.2, 0, 0}).ok());
  EXPECT_NE(simulation.state_hash(), moved);
  simulation.restore(start);
  simulation.advance(100);
  EXPECT_EQ(simulation.vat_offset(), Vec3::Zero());
}

TEST(MovedVat, AddsToItsOwnMotion) {
  Scene scene = plain();
  scene.vat->motion = SlideMotion{{0, 1, 0}, 0.2, 1};
  Simulation simulation = make_simulation(scene);
  ASSERT_TRUE(simulation.move_vat({0.3, 0.1, 0}).ok());
  advance_to(simulation, 1.5);
  EXPECT_LT((simulation.vat_offset() - Vec3(0.3, 0.3, 0)).norm(), 1e-12);
}

TEST(MovedVat, WakesSleepingBodies) {
  Scene scene = plain();
  scene.sleeping = Sleeping{0.05, 0.1};
  Simulation simulation = make_advanced(scene, 20000);
  ASSERT_EQ(simulation.sleeping_body_count(), 1U);
  ASSERT_TRUE(simulation.move_vat({0.5, 0, 0}).ok());
  EXPECT_EQ(simulation.sleeping_body_count(), 0U);
  simulation.advance(6000);  // of 7000 steps
  EXPECT_EQ(simulation.sleeping_body_count(), 0U) << "no body sleeps while the vat moves";
  simulation.advance(30000);
  EXPECT_EQ(simulation.sleeping_body_count(), 1U);
}

TEST(MovedVat, IsRefusedAtImpossiblePlaces) {
  const auto error = [](const Scene& scene, const Vec3& offset) {
    Simulation simulation = make_simulation(scene);
    const std::uint64_t hash = simulation.state_hash();
    const Status status = simulation.move_vat(offset);
    if (status) return std::string("none");
    EXPECT_EQ(simulation.state_hash(), hash);
    EXPECT_EQ(status.errors()[0].path, "/offset");
    return status.errors()[0].code;
  };
  EXPECT_EQ(error(plain(), {2, -2, 2}), "none");
  EXPECT_EQ(error(plain(), {0, -2.001, 0}), "out_of_range");
  EXPECT_EQ(error(plain(), {0, 0, std::nan("")}), "out_of_range");
  Scene scene = plain();
  scene.vat.reset();
  EXPECT_EQ(error(scene, {0, 0, 0}), "no_vat");
  scene = plain();
  scene.periodic = Periodicity{{-1, -1, 0}, {1, 1, 0}, {false, true, false}};
  EXPECT_EQ(error(scene, {1, 0, 0}), "none");
  EXPECT_EQ(error(scene, {0, 1, 0}), "not_allowed");
}

}  // namespace
}  // namespace vat::test::vat_by_hand_test
