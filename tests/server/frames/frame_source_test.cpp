#include "server/frames/frame_source.h"

#include <gtest/gtest.h>

namespace vat::frame_source_test {
namespace {

constexpr double kError = 0.005;  // [m]: a grid of 0.01 m

PublishedState make_state(double x = 0.5) {
  PublishedState state;
  state.header.epoch = 1;
  state.bodies.resize(2);
  state.bodies[0].id = 1;
  state.bodies[0].positions = {{x, 0.5, 0.5}, {0.2, 0.2, 0.2}};
  state.bodies[0].attributes[0] = {1, 2};
  state.bodies[1].id = 2;
  state.bodies[1].kind = BodyKind::rigid;
  state.bodies[1].center_of_mass = {0.1, 0.2, 0.3};
  state.bodies[1].bounding_radius = 0.1;
  state.has_vat = true;
  return state;
}

Subscription wish(double max_error) {
  Subscription wish;
  wish.max_error = max_error;
  return wish;
}

FrameCut cut(const Subscription& wish, unsigned coarseness = 1, std::uint8_t detail = kFullDetail) {
  return {wish, 0, coarseness, detail};
}

std::span<const std::uint8_t> bytes_of(const SharedFrame& frame) {
  return {reinterpret_cast<const std::uint8_t*>(frame->data()), frame->size()};
}

class FrameSourceTest : public testing::Test {
 protected:
  /// Publishes a possibly changed state as the next tick.
  void publish(PublishedState state) {
    state.header.tick = ++tick_;
    source.publish(state);
  }
  std::shared_ptr<const GridFrame> frame(double max_error = kError) {
    return source.frame(cut(wish(max_error)));
  }

  ServerMetrics metrics;
  FrameSource source{Vat{Vec3::Zero(), Vec3::Ones(), true, {}}, metrics};

 private:
  std::uint64_t tick_ = 0;
};

TEST_F(FrameSourceTest, OneFrameServesAllOfACut) {
  publish(make_state());
  EXPECT_EQ(frame(), frame());
  EXPECT_NE(frame(), frame(2 * kError));
  EXPECT_EQ(frame()->scale.grid.quantum, 2 * kError);
  const auto first = frame();
  publish(make_state());
  EXPECT_NE(frame(), first) << "frame of another tick";
  EXPECT_EQ(first->header.tick, 1U) << "a frame in use does not change";
  EXPECT_EQ(frame()->header.tick, 2U);
}

TEST_F(FrameSourceTest, OnlyChangedStatesHaveNewNumbers) {
  publish(make_state());
  EXPECT_EQ(source.number(), 1U);
  for (int i = 0; i < 10; ++i) publish(make_state());
  EXPECT_EQ(source.number(), 1U);
  EXPECT_EQ(frame()->header.number, 1U);
  publish(make_state(0.5001));
  EXPECT_EQ(source.number(), 2U);
  EXPECT_EQ(frame()->header.number, 2U);
}

TEST_F(FrameSourceTest, EveryOtherDifferenceIsAChange) {
  const auto changed = [](auto change) {
    PublishedState state = make_state();
    change(state);
    return state;
  };
  const std::vector<PublishedState> states = {
      changed([](PublishedState& s) { s.bodies[0].positions[1].z() += 0.1; }),
      changed([](PublishedState& s) {
        s.bodies[0].positions.push_back({0.3, 0.3, 0.3});
      }),
      changed([](PublishedState& s) { s.bodies[0].attributes[0][1] = 3; }),
      changed([](PublishedState& s) { s.bodies[0].id = 7; }),
      changed([](PublishedState& s) { s.bodies[0].kind = BodyKind::deformable; }),
      changed([](PublishedState& s) { s.bodies[1].center_of_mass[2] += 1e-9; }),
      changed([](PublishedState& s) {
        s.bodies[1].orientation = {0, 1, 0, 0};
      }),
      changed([](PublishedState& s) { s.bodies.pop_back(); }),
      changed([](PublishedState& s) { s.vat_offset.x() = 1e-9; }),
      changed([](PublishedState& s) { s.has_vat = false; }),
      changed([](PublishedState& s) { s.header.epoch = 2; }),
      changed([](PublishedState& s) { s.header.playing = true; }),
      changed([](PublishedState& s) { s.header.slow = true; }),
  };
  for (const PublishedState& state : states) {
    publish(make_state());
    const std::uint32_t before = source.number();
    publish(state);
    EXPECT_EQ(source.number(), before + 1);
  }
}

TEST_F(FrameSourceTest, ChangesBelowTheGridAreOmitted) {
  publish(make_state(0.5));
  const auto coarse = frame();
  const auto fine = frame(kError / 10);
  publish(make_state(0.5024));  // moved from a grid position by a quarter of the coarse quantum
  EXPECT_TRUE(show_the_same(*coarse, *frame()));
  EXPECT_FALSE(show_the_same(*fine, *frame(kError / 10)));
}

TEST_F(FrameSourceTest, CoarserByTheRequestedError) {
  publish(make_state());
  EXPECT_EQ(source.frame(cut(wish(kError), 4))->scale.grid.quantum, 8 * kError);
  const double finest = frame(0)->scale.grid.quantum;
  EXPECT_EQ(source.frame(cut(wish(0), 2))->scale.grid.quantum, 2 * finest);
  Subscription speeds = wish(kError);
  speeds.attribute_errors[0] = 0.5;
  const auto shown = source.frame(cut(speeds, 2));
  EXPECT_EQ(shown->scale.attribute_quanta[0], 2);
  EXPECT_EQ(shown->blocks[1].attributes[0], (std::vector<std::int32_t>{1, 1}));
}

TEST_F(FrameSourceTest, OnlyTheParticlesThatAreAskedFor) {
  PublishedState state = make_state();
  state.bodies[0].attributes = {};
  state.bodies[0].positions.assign(1000, Vec3(0.5, 0.5, 0.5));
  state.bodies[0].positions[7] = Vec3(0.1, 0.1, 0.1);
  publish(state);
  const auto count = [](const GridFrame& shown) { return shown.blocks[1].particle_count(); };
  EXPECT_EQ(count(*frame()), 1000U);
  EXPECT_NEAR(static_cast<double>(count(*source.frame(cut(wish(kError), 1, 1)))), 250, 100);
  Subscription corner = wish(kError);
  corner.selection.region = FrameRegion{Vec3::Zero(), Vec3(0.2, 0.2, 0.2)};
  const auto part = source.frame(cut(corner));
  EXPECT_EQ(part->blocks[1].numbers, std::vector<std::uint32_t>{7});
  EXPECT_EQ(part->scale.grid, frame()->scale.grid);
}

TEST_F(FrameSourceTest, UsesAvailableReferences) {
  FrameDecoder decoder;
  const auto show = [&](const HeldFrames& held) {
    const SharedFrame bytes = source.encode(*frame(), held, 1);
    const auto decoded = decoder.decode(bytes_of(bytes));
    EXPECT_TRUE(decoded) << decoded.errors().front().code;
    EXPECT_TRUE(show_the_same(*decoded.value(), *frame()));
    return is_key_frame(bytes_of(bytes));
  };
  publish(make_state(0.3));
  const auto first = frame();
  EXPECT_TRUE(show({}));
  publish(make_state(0.4));
  const auto second = frame();
  show({first, nullptr});
  publish(make_state(0.5));
  show({second, first});
  publish(make_state(-2));
  EXPECT_TRUE(show({second, first})) << "another grid";
  PublishedState next = make_state(-2);
  const auto third = frame();
  next.header.epoch = 2;
  publish(next);
  EXPECT_TRUE(show({third, second})) << "another epoch";
}

}  // namespace
}  // namespace vat::frame_source_test
