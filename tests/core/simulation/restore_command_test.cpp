// Restoring a removed body with its motion.

#include <gtest/gtest.h>

#include <cmath>

#include "core/limits.h"
#include "tests/support/edited_scene.h"
#include "tests/support/errors.h"
#include "tests/support/saved_bits.h"

namespace vat::test::restore_command_test {
namespace {

BodyMotion motion_of(const BodyView& body) {
  if (body.pose) return {{}, {}, body.pose};
  return {copy_of(body.positions), copy_of(body.velocities)};
}

class RestoredBody : public testing::Test {
 protected:
  BodyView body(std::size_t index) const { return simulation.bodies()[index]; }
  /// Removes a body. Returns its description and motion.
  std::pair<BodyDescription, BodyMotion> take(std::size_t index) {
    std::pair<BodyDescription, BodyMotion> taken{simulation.scene().bodies[index],
                                                 motion_of(body(index))};
    EXPECT_TRUE(simulation.remove_body(body(index).id).ok());
    return taken;
  }
  Simulation simulation = make_simulation(sampled_scene());
};

TEST_F(RestoredBody, IsBentAndMovesAsItDid) {
  simulation.advance(150);
  for (int body_of_each_kind = 0; body_of_each_kind < 3; ++body_of_each_kind) {
    const std::string name(body(0).name);
    const auto places = copy_of(body(0).positions);
    const auto velocities = copy_of(body(0).velocities);
    const auto [description, motion] = take(0);
    const Result<BodyId> id = simulation.add_body(description, motion);
    ASSERT_TRUE(id.ok()) << id.errors()[0].path << ' ' << id.errors()[0].message;
    const BodyView back = body(2);
    EXPECT_EQ(back.id, id.value());
    EXPECT_EQ(back.name, name);
    EXPECT_EQ(simulation.scene().bodies[2].position, description.position);
    for (std::size_t i = 0; i < places.size(); ++i) {
      EXPECT_LT((back.positions[i] - places[i]).norm(), 1e-14);
      EXPECT_LT((back.velocities[i] - velocities[i]).norm(), 1e-13);
    }
    if (!back.pose) {
      EXPECT_EQ(copy_of(back.positions), motion.positions);
      EXPECT_EQ(copy_of(back.velocities), motion.velocities);
      continue;
    }
    EXPECT_EQ(back.pose->center_of_mass, motion.pose->center_of_mass);
    EXPECT_LT(back.pose->orientation.angularDistance(motion.pose->orientation), 1e-7);
    EXPECT_LT((back.pose->velocity - motion.pose->velocity).norm(), 1e-14);
    EXPECT_LT((back.pose->angular_velocity - motion.pose->angular_velocity).norm(), 1e-13);
  }
  expect_goes_on(simulation, 5);
}

// The last body returns to its index, so the run is unchanged.
TEST_F(RestoredBody, ContinuesAsWithoutTheRemoval) {
  simulation.advance(150);
  const Snapshot before = simulation.snapshot();
  // A new body makes the forces of the last step invalid, and so does this command.
  ASSERT_TRUE(simulation.set_gravity(simulation.scene().gravity).ok());
  simulation.advance(100);
  const RigidPose expected = *body(2).pose;
  const auto others = copy_of(body(1).positions);
  simulation.restore(before);
  const auto [description, motion] = take(2);
  ASSERT_TRUE(simulation.add_body(description, motion).ok());
  simulation.advance(100);
  // Rounding of momenta by velocities, amplified by collisions.
  EXPECT_LT((body(2).pose->center_of_mass - expected.center_of_mass).norm(), 1e-10);
  EXPECT_LT((body(2).pose->velocity - expected.velocity).norm(), 1e-8);
  const auto now = copy_of(body(1).positions);
  for (std::size_t i = 0; i < now.size(); ++i) EXPECT_LT((now[i] - others[i]).norm(), 1e-10);
}

TEST_F(RestoredBody, MayHaveBegunOutsideTheMovedVat) {
  ASSERT_TRUE(simulation.move_vat({1, 0, 0}).ok());
  simulation.advance(3000);
  ASSERT_GT(simulation.vat_offset().x(), 0.999);
  for (int n = 0; n < 3; ++n) {
    const auto [description, motion] = take(0);
    EXPECT_FALSE(simulation.add_body(description).ok());
    EXPECT_TRUE(simulation.add_body(description, motion).ok()) << description.name;
  }
}

TEST_F(RestoredBody, IsRefusedWithInvalidValuesAndChangesNothing) {
  const auto [pool, flowing] = take(0);
  const auto [cube, bent] = take(0);
  const auto [crate, turning] = take(0);
  const std::uint64_t hash = simulation.state_hash();
  const auto error = [&](const BodyDescription& description, const BodyMotion& motion) {
    const std::string text = errors_of(simulation.add_body(description, motion));
    EXPECT_EQ(simulation.state_hash(), hash);
    return text;
  };
  BodyMotion motion = bent;
  motion.positions.pop_back();
  EXPECT_EQ(error(cube, motion), "out_of_range /state/positions");
  motion = bent;
  motion.velocities.emplace_back(0, 0, 0);
  EXPECT_EQ(error(cube, motion), "out_of_range /state/velocities");
  motion = bent;
  motion.positions[3].z() = std::nan("");
  EXPECT_EQ(error(cube, motion), "out_of_range /state/positions/3");
  motion = flowing;
  motion.velocities[2] = {2 * kMaxSpeed, 0, 0};
  EXPECT_EQ(error(pool, motion), "out_of_range /state/velocities/2");
  motion = flowing;
  motion.positions[5].z() = -0.1;
  EXPECT_EQ(error(pool, motion), "outside_vat /state");
  EXPECT_EQ(error(cube, turning), "out_of_range /state/positions");
  EXPECT_EQ(error(crate, bent), "missing /state");
  motion = turning;
  motion.pose->orientation = Quat(2, 0, 0, 0);
  EXPECT_EQ(error(crate, motion), "out_of_range /state/orientation");
  motion = turning;
  motion.pose->center_of_mass.x() = 0.95;
  EXPECT_EQ(error(crate, motion), "outside_vat /state");
  motion = turning;
  motion.pose->velocity.x() = std::nan("");
  EXPECT_EQ(error(crate, motion), "out_of_range /state/velocity");
  motion = turning;
  motion.pose->angular_velocity.x() = 2 * kMaxAngularSpeed;
  EXPECT_EQ(error(crate, motion), "out_of_range /state/angular_velocity");
  BodyDescription wrong = cube;
  wrong.material = "gold";
  EXPECT_EQ(error(wrong, bent), "unknown_name /body/material");
}

}  // namespace
}  // namespace vat::test::restore_command_test
