#include "protocol/client/exchange/frame_receiver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace vat::client::frame_receiver_test {
namespace {

using testing::ElementsAre;
using testing::FloatNear;

constexpr double kMaxError = 1e-3;

PublishedState make_state() {
  PublishedState state;
  state.header.epoch = 4;
  state.header.number = 12;
  state.header.tick = 30;
  state.header.time = 0.6;
  state.has_vat = true;
  state.vat_offset = Vec3(0.1, 0, 0);
  PublishedState::Body water;
  water.id = 1;
  water.positions = {Vec3(0.1, 0.2, 0.3), Vec3(0.4, 0.5, 0.6)};
  water.numbers = {2, 5};
  water.attributes[static_cast<std::size_t>(FrameAttribute::speed)] = {1.5F, 0.5F};
  PublishedState::Body ball;
  ball.id = 2;
  ball.kind = vat::BodyKind::rigid;
  ball.center_of_mass = {0.5, 0.5, 0.5};
  ball.orientation = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // a quarter turn about z
  ball.bounding_radius = 0.1;
  state.bodies = {water, ball};
  return state;
}

std::vector<std::uint8_t> encode(const PublishedState& state) {
  FrameScale scale;
  scale.grid = make_frame_grid({0, 0, 0}, {1, 1, 1}, kMaxError);
  scale.attribute_quanta[static_cast<std::size_t>(FrameAttribute::speed)] = 0.01;
  GridFrame frame;
  make_grid_frame(state, scale, frame);
  return encode_key_frame(frame);
}

SessionDescription make_description() {
  SessionDescription description;
  description.bodies = {{.body = 1, .name = "water", .kind = BodyKind::liquid},
                        {.body = 2,
                         .name = "ball",
                         .kind = BodyKind::rigid,
                         .local_positions = std::vector<double>{0.1, 0, 0, 0, 0.1, 0}}};
  return description;
}

TEST(ClientFrames, HaveSpansOfPositionsAndAttributes) {
  FrameReceiver receiver;
  receiver.describe(make_description());
  const FrameReceiver::Reception reception = receiver.receive(encode(make_state()));
  ASSERT_NE(reception.frame, nullptr) << reception.fault;
  const Frame& frame = *reception.frame;
  EXPECT_EQ(reception.number, 12U);
  EXPECT_EQ(frame.epoch, 4U);
  EXPECT_EQ(frame.tick, 30U);
  EXPECT_EQ(frame.time, 0.6);
  EXPECT_LE(frame.max_error, 1.0001 * kMaxError);
  ASSERT_TRUE(frame.vat_offset);
  EXPECT_NEAR(frame.vat_offset->x(), 0.1, frame.max_error);
  ASSERT_EQ(frame.bodies.size(), 2U);
  const Frame::Body& water = frame.bodies[0];
  EXPECT_EQ(water.name, "water");
  ASSERT_EQ(water.positions.size(), 2U);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(water.positions[1][axis], 0.4 + 0.1 * axis, frame.max_error);
  }
  EXPECT_THAT(std::vector(water.numbers.begin(), water.numbers.end()), ElementsAre(2U, 5U));
  EXPECT_THAT(std::vector(water.speed.begin(), water.speed.end()),
              ElementsAre(FloatNear(1.5F, 0.005F), FloatNear(0.5F, 0.005F)));
  EXPECT_TRUE(water.density.empty());
}

TEST(ClientFrames, HaveTheParticlesOfRigidBodies) {
  FrameReceiver receiver;
  receiver.describe(make_description());
  const FrameReceiver::Reception reception = receiver.receive(encode(make_state()));
  ASSERT_NE(reception.frame, nullptr) << reception.fault;
  const Frame::Body& ball = reception.frame->bodies[1];
  EXPECT_EQ(ball.kind, BodyKind::rigid);
  EXPECT_NEAR(ball.center_of_mass.z(), 0.5, kMaxError);
  ASSERT_EQ(ball.positions.size(), 2U);
  EXPECT_LT((ball.positions[0] - Vec3(0.5, 0.6, 0.5)).norm(), 2 * kMaxError);
  EXPECT_LT((ball.positions[1] - Vec3(0.4, 0.5, 0.5)).norm(), 2 * kMaxError);
}

TEST(ClientFrames, WithoutADescriptionHaveNoNames) {
  FrameReceiver receiver;
  const FrameReceiver::Reception reception = receiver.receive(encode(make_state()));
  ASSERT_NE(reception.frame, nullptr) << reception.fault;
  EXPECT_EQ(reception.frame->bodies[0].name, "");
  EXPECT_EQ(reception.frame->bodies[0].positions.size(), 2U);
  EXPECT_TRUE(reception.frame->bodies[1].positions.empty());
}

GridFrame make_grid(std::uint32_t number) {
  PublishedState state = make_state();
  state.header.number = number;
  state.bodies[0].positions[0].x() += 0.01 * number;
  FrameScale scale;
  scale.grid = make_frame_grid({0, 0, 0}, {1, 1, 1}, kMaxError);
  GridFrame frame;
  make_grid_frame(state, scale, frame);
  return frame;
}

TEST(ClientFrames, AfterALostReferenceAskForOneKeyFrame) {
  const GridFrame first = make_grid(1);
  const GridFrame second = make_grid(2);
  const GridFrame third = make_grid(3);
  const GridFrame fourth = make_grid(4);
  FrameEncoder encoder;
  FrameReceiver receiver;
  EXPECT_NE(receiver.receive(encode_key_frame(first)).frame, nullptr);
  // The second frame is lost.
  FrameReceiver::Reception lost = receiver.receive(encoder.encode(third, {.first = &second}));
  EXPECT_EQ(lost.frame, nullptr);
  EXPECT_EQ(lost.number, 3U);
  EXPECT_TRUE(lost.asks_for_key);
  EXPECT_FALSE(lost.is_broken);
  lost = receiver.receive(encoder.encode(fourth, {.first = &third}));
  EXPECT_EQ(lost.frame, nullptr);
  EXPECT_EQ(lost.number, 4U);
  EXPECT_FALSE(lost.asks_for_key);
  EXPECT_FALSE(lost.is_broken);
  EXPECT_EQ(lost.fault, "");
  EXPECT_NE(receiver.receive(encode_key_frame(make_grid(5))).frame, nullptr);
}

TEST(ClientFrames, ATruncatedHeaderBreaksTheConnection) {
  FrameReceiver receiver;
  const FrameReceiver::Reception reception = receiver.receive(std::vector<std::uint8_t>(11));
  EXPECT_EQ(reception.frame, nullptr);
  EXPECT_TRUE(reception.is_broken);
  EXPECT_NE(reception.fault, "");
}

}  // namespace
}  // namespace vat::client::frame_receiver_test
