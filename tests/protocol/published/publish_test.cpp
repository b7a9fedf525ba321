#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "protocol/frame/grid_frame.h"
#include "tests/support/memory/allocation_counter.h"
#include "tests/support/scenes.h"

namespace vat::publish_test {
namespace {

using namespace test;

/// A falling block of water and a ball.
Simulation make_falling() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.001);
  scene.materials = {make_liquid("water", 1000, {.stiffness = 100, .support_radius = 0.2}),
                     make_material("wood", 600)};
  BodyDescription water{"water", BodyKind::liquid, "water",
                        BoxShape{{0.5, 0.5, 0.5}, {0.4, 0.4, 0.4}}, 0.1};
  water.velocity = {3, 0, 4};
  BodyDescription ball = make_body("ball", BodyKind::rigid, "wood",
                                   make_particles(make_lattice(3, 3, 3, 0.1), 0.1), 0.05);
  ball.position = {2, 2, 2};
  scene.bodies = {water, ball};
  return make_simulation(scene);
}

TEST(Publish, CopiesRequestedAttributesOnly) {
  const Simulation simulation = make_falling();
  const PublishedState plain = publish(simulation);
  for (const auto& column : plain.bodies[0].attributes) EXPECT_TRUE(column.empty());
  const PublishedState pressures = publish(simulation, {false, false, true});
  EXPECT_TRUE(pressures.bodies[0].attributes[0].empty());
  EXPECT_EQ(pressures.bodies[0].attributes[2].size(), 64U);
  EXPECT_TRUE(pressures.bodies[1].attributes[2].empty()) << "a ball has no pressure";
}

// Half a quantum, plus the rounding of a float32.
TEST(Publish, AttributesAreWithinTheirErrors) {
  const Simulation simulation = make_falling();
  const ByAttribute<double> errors{0.003, 0.5, 20, 0.1};
  FrameScale scale{make_frame_grid({0, 0, 0}, {3, 3, 3}, 0.001), {}};
  for (std::size_t a = 0; a < kFrameAttributes; ++a) scale.attribute_quanta[a] = 2 * errors[a];
  GridFrame frame;
  make_grid_frame(publish(simulation, {true, true, true, true}), scale, frame);
  const LiquidFields fields = simulation.liquid_fields(simulation.bodies()[0].id).value();
  const auto& columns = frame.blocks[0].attributes;
  for (std::size_t i = 0; i < 64; ++i) {
    const ByAttribute<double> exact{simulation.bodies()[0].velocities[i].norm(), fields.density[i],
                                    fields.pressure[i], 0};  // no tick has run
    for (std::size_t a = 0; a < kFrameAttributes; ++a) {
      const double sent = scale.attribute_quanta[a] * columns[a][i];
      EXPECT_NEAR(sent, exact[a], errors[a] + std::abs(exact[a]) * 1e-7);
    }
  }
  EXPECT_EQ(columns[0][0], std::lround(5 / 0.006)) << "the initial speed is 5 m/s";
}

/// Liquid under gravity only, half of it in a drain, and a cube with an applied force.
Simulation make_pushed() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.001);
  scene.numerics.tick = 0.02;
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_liquid("water", 1000, {.stiffness = 0, .support_radius = 0.2}),
                     make_material("wood", 600)};
  scene.bodies = {make_body("water", BodyKind::liquid, "water",
                            make_particles(make_lattice(4, 4, 4, 0.1), 1), 0.05),
                  make_body("cube", BodyKind::deformable, "wood",
                            make_particles(make_lattice(2, 2, 2, 0.1), 0.5), 0.05)};
  scene.bodies[1].position = {5, 0, 0};
  scene.drains = {{"hole", {-1, -1, -1}, {0, 1, 1}}};
  return make_simulation(scene);
}

TEST(Publish, AccelerationsAreChangesOfVelocities) {
  Simulation simulation = make_pushed();
  StatePublisher publisher;
  PublishedState state;
  const auto accelerations = [&](std::size_t body) {
    publisher.publish(simulation, {false, false, false, true}, state);
    return state.bodies[body].attributes[3];
  };
  EXPECT_EQ(accelerations(1), std::vector<float>(8, 0)) << "before the first tick";
  ASSERT_TRUE(simulation.apply_force(simulation.bodies()[1].id, {4 * 3, 0, 4 * 9.81}, 1).ok());
  for (int tick = 0; tick < 3; ++tick) {
    publisher.remember(simulation, 0.02);
    simulation.advance(20);
    ASSERT_EQ(accelerations(0).size(), 32U) << "the drain has removed the others";
    for (const float a : accelerations(0)) EXPECT_NEAR(a, 9.81, 1e-6);
    for (const float a : accelerations(1)) EXPECT_NEAR(a, 3, 1e-6);
  }
  publisher.forget();
  EXPECT_EQ(accelerations(0), std::vector<float>(32, 0));
}

bool equal(const PublishedState& a, const PublishedState& b) {
  return a.header.time == b.header.time && a.has_vat == b.has_vat && a.vat_offset == b.vat_offset &&
         a.bodies == b.bodies;
}

/// Two balls in a vat.
Simulation make_balls() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.001);
  scene.materials = {make_material("wood", 600)};
  scene.vat = Vat{{-1, -1, -1}, {9, 9, 9}, true, {}};
  for (int i = 0; i < 3; ++i) {
    scene.bodies.push_back(make_body("body" + std::to_string(i),
                                     i == 1 ? BodyKind::deformable : BodyKind::rigid, "wood",
                                     make_particles(make_lattice(3, 3, 3, 0.1), 0.1), 0.05));
    scene.bodies.back().position = {2.0 * i, 2, 2};
  }
  return make_simulation(scene);
}

TEST(Publish, ReplacesAllOfAReusedState) {
  const Simulation falling = make_falling();
  const Simulation balls = make_balls();
  StatePublisher publisher;
  PublishedState state;
  publisher.publish(falling, {true, true, true}, state);
  state.header.tick = 7;
  publisher.publish(balls, {}, state);
  EXPECT_TRUE(equal(state, publish(balls)));
  EXPECT_EQ(state.header.tick, 0U);
  publisher.publish(falling, {false, true, false}, state);
  EXPECT_TRUE(equal(state, publish(falling, {false, true, false})));
}

TEST(Publish, AllocatesNothingInMemoryThatHasHeldAsMuch) {
  Simulation simulation = make_falling();
  StatePublisher publisher;
  PublishedState state;
  publisher.publish(simulation, {true, false, false}, state);
  simulation.advance(3);
  const std::size_t before = allocation_count();
  publisher.publish(simulation, {true, false, false}, state);
  EXPECT_EQ(allocation_count(), before);
  EXPECT_TRUE(equal(state, publish(simulation, {true, false, false})));
}

TEST(Publish, ARigidBodysRadiusReachesItsFarthestParticle) {
  const PublishedState state = publish(make_falling());
  EXPECT_NEAR(state.bodies[1].bounding_radius, 0.1 * std::sqrt(3), 1e-12);
}

}  // namespace
}  // namespace vat::publish_test
