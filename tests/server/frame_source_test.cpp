#include "server/session/frame_source.h"

#include <gtest/gtest.h>

namespace vat {
namespace {

constexpr double kError = 0.005;  // [m]: a grid of 0.01 m

PublishedState make_state(double x = 0.5) {
  PublishedState state;
  state.header.epoch = 1;
  state.bodies.resize(2);
  state.bodies[0].id = 1;
  state.bodies[0].positions = {{x, 0.5, 0.5}, {0.2, 0.2, 0.2}};
  state.bodies[1].id = 2;
  state.bodies[1].kind = BodyKind::rigid;
  state.bodies[1].center_of_mass = {0.1, 0.2, 0.3};
  state.bodies[1].bounding_radius = 0.1;
  state.has_vat = true;
  return state;
}

class FrameSourceTest : public testing::Test {
 protected:
  /// The next tick, of a state that may have changed.
  void publish(PublishedState state) {
    state.header.tick = ++tick_;
    source.publish(std::move(state), 2);
  }
  std::uint64_t tick_of(double max_error) {
    const std::string& bytes = *source.frame(max_error);
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    return decode_key_frame({data, bytes.size()}).value().header.tick;
  }
  bool has_encoded(std::uint64_t frames) {
    const std::string sample = "\nvat_frames_encoded_total " + std::to_string(frames) + '\n';
    return metrics.to_text({}).find(sample) != std::string::npos;
  }

  ServerMetrics metrics;
  FrameSource source{Vat{Vec3::Zero(), Vec3::Ones(), true, {}}, metrics};

 private:
  std::uint64_t tick_ = 0;
};

TEST_F(FrameSourceTest, NothingIsEncodedUntilItIsAskedFor) {
  publish(make_state());
  publish(make_state(0.6));
  EXPECT_TRUE(has_encoded(0));
  EXPECT_EQ(tick_of(kError), 2U);
  EXPECT_TRUE(has_encoded(1));
}

TEST_F(FrameSourceTest, OneEncodingServesAllOfAnAccuracy) {
  publish(make_state());
  EXPECT_EQ(source.frame(kError), source.frame(kError));
  EXPECT_EQ(source.content(kError), source.content(kError));
  EXPECT_NE(source.content(kError), source.content(2 * kError));
  EXPECT_TRUE(has_encoded(2));
}

TEST_F(FrameSourceTest, AnUnchangedStateIsNotEncodedAgain) {
  publish(make_state());
  const std::uint64_t content = source.content(kError);
  EXPECT_NE(content, 0U);
  for (int i = 0; i < 10; ++i) {
    publish(make_state());
    EXPECT_EQ(source.content(kError), content);
  }
  EXPECT_TRUE(has_encoded(1));
  EXPECT_EQ(tick_of(kError), 11U) << "but who wants one gets that of the present tick";
  EXPECT_EQ(source.content(kError), content);
}

TEST_F(FrameSourceTest, WhatTheGridDoesNotTellIsNoChange) {
  publish(make_state(0.5));
  const std::uint64_t coarse = source.content(kError);
  const std::uint64_t fine = source.content(kError / 10);
  publish(make_state(0.5024));  // a quarter of the coarse grid's quantum from a position on it
  EXPECT_EQ(source.content(kError), coarse);
  EXPECT_NE(source.content(kError / 10), fine);
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
      changed([](PublishedState& s) { s.bodies[0].id = 7; }),
      changed([](PublishedState& s) { s.bodies[0].kind = BodyKind::deformable; }),
      changed([](PublishedState& s) { s.bodies[1].center_of_mass[2] += 0.01; }),
      changed([](PublishedState& s) {
        s.bodies[1].orientation = {0, 1, 0, 0};
      }),
      changed([](PublishedState& s) { s.bodies.pop_back(); }),
      changed([](PublishedState& s) { s.vat_offset.x() = 0.01; }),
      changed([](PublishedState& s) { s.has_vat = false; }),
      changed([](PublishedState& s) { s.header.epoch = 2; }),
      changed([](PublishedState& s) { s.header.playing = true; }),
      changed([](PublishedState& s) { s.header.slow = true; }),
  };
  for (const PublishedState& state : states) {
    publish(make_state());
    const std::uint64_t before = source.content(kError);
    publish(state);
    EXPECT_NE(source.content(kError), before);
  }
}

TEST_F(FrameSourceTest, AnotherGridIsAChange) {
  publish(make_state());
  const std::uint64_t content = source.content(kError);
  publish(make_state(-0.5));
  publish(make_state());
  EXPECT_NE(source.content(kError), content) << "the grid begins further out now";
}

// Two watchers are at most two accuracies; others are of the past.
TEST_F(FrameSourceTest, ForgetsAccuraciesThatNobodyAsksFor) {
  publish(make_state());
  const std::uint64_t content = source.content(kError);
  for (int i = 2; i < 5; ++i) source.content(i * kError);
  publish(make_state());
  EXPECT_NE(source.content(kError), content);
}

}  // namespace
}  // namespace vat
