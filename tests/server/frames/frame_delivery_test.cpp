#include "server/frames/frame_delivery.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <utility>

#include "server/messages/limits.h"
#include "tests/server/fixture/fake_connection.h"

namespace vat::test::frame_delivery_test {
namespace {

class Wakes final : public FrameWaker {
 public:
  void wake(ConnectionId client) override { clients.push_back(client); }
  void frame_rejected(ConnectionId client, std::uint32_t number) override {
    delivery->restart(client, number);
  }
  FrameDelivery* delivery = nullptr;
  std::vector<ConnectionId> clients;
};

/// A viewer and the frames that it received.
struct TestViewer {
  std::shared_ptr<FakeConnection> connection;
  std::shared_ptr<ClientOutbox> outbox;
  std::vector<std::uint64_t> ticks() const {
    std::vector<std::uint64_t> ticks;
    for (const GridFrame& frame : connection->frames()) ticks.push_back(frame.header.tick);
    return ticks;
  }
  FrameHeader last() const { return connection->frames().back().header; }
};

class FrameDeliveryTest : public testing::Test {
 protected:
  static constexpr std::uint32_t kEpoch = 1;

  TestViewer add(Subscription wish = {}) {
    TestViewer viewer;
    viewer.connection = std::make_shared<FakeConnection>(++last_id_);
    viewer.outbox = std::make_shared<ClientOutbox>(viewer.connection);
    const std::uint64_t membership = viewer.outbox->join();
    viewer.outbox->start_epoch(membership, kEpoch);
    delivery.add(viewer.outbox, viewer.outbox->subscribe(membership, wakes, now), std::move(wish));
    return viewer;
  }
  /// Publishes a state in which the particles have moved since all previous states.
  void publish(std::uint64_t tick) { publish(tick, 1e-3 * static_cast<double>(++states_)); }
  void publish(std::uint64_t tick, double x, bool playing = true) {
    PublishedState state;
    state.header.playing = playing;
    state.header.epoch = kEpoch;
    state.header.tick = tick;
    state.bodies.resize(1);
    state.bodies[0].id = 1;
    state.bodies[0].positions.assign(particles, {x, 0.5, 0.5});
    now += std::chrono::milliseconds(20);
    delivery.publish(state, now);
  }
  void reject(const TestViewer& viewer, std::uint32_t number) {
    wakes->delivery = &delivery;
    EXPECT_TRUE(viewer.outbox->acknowledge(number, now, true));
    delivery.retry(std::exchange(wakes->clients, {}), now);
  }
  void acknowledge_all(const TestViewer& viewer) {
    EXPECT_TRUE(viewer.outbox->acknowledge(viewer.last().number, now));
    delivery.retry(std::exchange(wakes->clients, {}), now);
  }

  static Subscription every(std::uint64_t ticks) {
    Subscription wish;
    wish.every = ticks;
    return wish;
  }
  bool counted(const std::string& sample) const {
    return metrics.to_text({}).find('\n' + sample + '\n') != std::string::npos;
  }

  SteadyClock::time_point now{std::chrono::hours(1)};
  ServerMetrics metrics;
  const std::shared_ptr<Wakes> wakes = std::make_shared<Wakes>();
  FrameDelivery delivery{Vat{Vec3::Zero(), Vec3::Ones(), true, {}}, metrics};

  std::size_t particles = 1;

 private:
  ConnectionId last_id_ = 0;
  int states_ = 0;
};

using Ticks = std::vector<std::uint64_t>;

TEST_F(FrameDeliveryTest, AViewerGetsTheTicksThatItAskedFor) {
  const TestViewer all = add();
  const TestViewer third = add(every(3));
  for (std::uint64_t tick = 1; tick <= 7; ++tick) {
    publish(tick);
    acknowledge_all(all);
    acknowledge_all(third);
  }
  EXPECT_EQ(all.ticks(), (Ticks{1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(third.ticks(), (Ticks{1, 3, 6})) << "the first state is sent immediately";
}

// A newer state may have replaced the state of the divisible tick.
TEST_F(FrameDeliveryTest, ASkippedTurnIsServedWithTheNextState) {
  const TestViewer third = add(every(3));
  for (const std::uint64_t tick : {1U, 2U, 4U, 5U, 7U, 8U}) {
    publish(tick);
    acknowledge_all(third);
  }
  EXPECT_EQ(third.ticks(), (Ticks{1, 4, 7}));
}

TEST_F(FrameDeliveryTest, ABusyViewerReceivesTheNewestStateLater) {
  const TestViewer slow = add();
  const TestViewer quick = add();
  for (std::uint64_t tick = 1; tick <= 50; ++tick) {
    publish(tick);
    acknowledge_all(quick);
  }
  EXPECT_EQ(quick.ticks().size(), 50u);
  EXPECT_EQ(slow.ticks(), (Ticks{1, 2, 3}));
  acknowledge_all(slow);
  EXPECT_EQ(slow.ticks(), (Ticks{1, 2, 3, 50}));
  EXPECT_EQ(slow.last().number, 50u) << "frames 4 to 49 are omitted";
  acknowledge_all(slow);
  EXPECT_EQ(slow.ticks().size(), 4u) << "there is no new state";
}

TEST_F(FrameDeliveryTest, UnchangedStatesAreOmitted) {
  const TestViewer viewer = add();
  publish(1, 0.5);
  for (std::uint64_t tick = 2; tick < 10; ++tick) {
    publish(tick, 0.5);
    acknowledge_all(viewer);
  }
  publish(10, 0.6);
  EXPECT_EQ(viewer.ticks(), (Ticks{1, 10}));
  EXPECT_EQ(viewer.last().number, 2u);
}

// Also in a paused session, in which no newer state comes.
TEST_F(FrameDeliveryTest, ARejectedFrameIsFollowedByOneKeyFrame) {
  const TestViewer viewer = add();
  publish(1, 0.1);
  publish(2, 0.2);
  publish(3, 0.3, false);
  ASSERT_EQ(viewer.ticks(), (Ticks{1, 2, 3}));
  ASSERT_TRUE(counted("vat_key_frames_encoded_total 1"));
  reject(viewer, 2);
  EXPECT_EQ(viewer.ticks(), (Ticks{1, 2, 3, 3}));
  EXPECT_TRUE(counted("vat_key_frames_encoded_total 2"));
  publish(4, 0.4);
  EXPECT_TRUE(counted("vat_key_frames_encoded_total 2")) << "it refers to the key frame";
  reject(viewer, 2);
  EXPECT_TRUE(counted("vat_key_frames_encoded_total 2")) << "the frame is before the key frame";
  reject(viewer, 3);
  EXPECT_TRUE(counted("vat_key_frames_encoded_total 3")) << "the key frame itself";
}

TEST_F(FrameDeliveryTest, AnEpochBeginsWithAFrameForAll) {
  const TestViewer third = add(every(3));
  publish(4);
  acknowledge_all(third);
  delivery.set_vat({});
  publish(0);
  EXPECT_EQ(third.ticks(), (Ticks{4, 0}));
}

TEST_F(FrameDeliveryTest, ARemovedViewerReceivesNoFrames) {
  const TestViewer viewer = add();
  publish(1);
  delivery.remove(1);
  publish(2);
  delivery.retry(std::vector<ConnectionId>{1, 7}, now);
  EXPECT_EQ(viewer.ticks(), (Ticks{1}));
}

TEST_F(FrameDeliveryTest, ViewersWithTheSameReferencesShareOneEncoding) {
  std::vector<TestViewer> viewers;
  for (int i = 0; i < 20; ++i) viewers.push_back(add());
  publish(1);
  publish(2);
  EXPECT_TRUE(counted("vat_frames_encoded_total 2"));
  const TestViewer late = add();
  for (std::uint64_t tick = 3; tick <= 6; ++tick) {
    for (const TestViewer& viewer : viewers) acknowledge_all(viewer);
    publish(tick);
  }
  // Two encodings for each of the ticks 3 and 4, until the late viewer has the same frames as the
  // others.
  EXPECT_TRUE(counted("vat_frames_encoded_total 8"));
  EXPECT_TRUE(counted("vat_frames_sent_total " + std::to_string(20 * 6 + 3)));
  EXPECT_EQ(late.ticks(), (Ticks{3, 4, 5}));
}

TEST_F(FrameDeliveryTest, ANewcomerToAStateAtRestSharesTheNextFrame) {
  const TestViewer first = add();
  publish(1, 0.5);
  const TestViewer second = add();
  publish(5, 0.5);
  EXPECT_EQ(first.ticks(), (Ticks{1}));
  for (std::uint64_t tick = 6; tick <= 8; ++tick) {
    acknowledge_all(first);
    acknowledge_all(second);
    publish(tick);
  }
  EXPECT_EQ(second.ticks(), (Ticks{5, 6, 7, 8}));
  EXPECT_TRUE(counted("vat_frames_encoded_total 7"));
}

// Twenty groups with different quanta, ten of which have two viewers. Of eight slots, four belong
// to the groups that waited longest. A viewer is omitted at most five times in a row.
TEST_F(FrameDeliveryTest, EveryViewerHasATurnWithTooManyGroups) {
  constexpr std::size_t kGroups = 20;
  constexpr std::uint64_t kTicks = 100;
  std::vector<TestViewer> viewers;
  for (std::size_t i = 0; i < kGroups; ++i) {
    Subscription wish;
    wish.max_error = 1e-4 * static_cast<double>(i + 1);
    viewers.push_back(add(wish));
    if (i < kGroups / 2) viewers.push_back(add(wish));
  }
  for (std::uint64_t tick = 1; tick <= kTicks; ++tick) {
    publish(tick, 0.01 * static_cast<double>(tick));
    for (const TestViewer& viewer : viewers) {
      if (!viewer.ticks().empty()) acknowledge_all(viewer);
    }
  }
  for (const TestViewer& viewer : viewers) {
    std::uint64_t last = 0;
    for (const std::uint64_t tick : viewer.ticks()) {
      EXPECT_LE(tick - last, 1 + kGroups / (kMaxFrameGroups / 2));
      last = tick;
    }
    EXPECT_GE(last + kGroups / (kMaxFrameGroups / 2), kTicks);
  }
  EXPECT_TRUE(counted("vat_frames_encoded_total " + std::to_string(kTicks * kMaxFrameGroups)));
}

// No newer state comes for them.
TEST_F(FrameDeliveryTest, APausedSessionServesEveryGroup) {
  std::vector<TestViewer> viewers;
  for (std::size_t i = 0; i < 2 * kMaxFrameGroups + 1; ++i) {
    Subscription wish;
    wish.max_error = 1e-4 * static_cast<double>(i + 1);
    viewers.push_back(add(wish));
  }
  publish(1, 0.1);
  EXPECT_FALSE(delivery.has_rest()) << "the next state serves them";
  publish(2, 0.9, false);
  for (int turns = 1; delivery.has_rest(); ++turns) {
    ASSERT_LE(turns, 2);
    delivery.serve_rest(now);
  }
  for (const TestViewer& viewer : viewers) EXPECT_THAT(viewer.ticks(), testing::Contains(2U));
  EXPECT_TRUE(counted("vat_frames_encoded_total " + std::to_string(3 * kMaxFrameGroups + 1)));
}

TEST_F(FrameDeliveryTest, SlowViewersShareTheFramesOfALowerRate) {
  const TestViewer quick = add();
  std::vector<TestViewer> slow = {add(), add(), add()};
  std::vector<std::size_t> acknowledged(slow.size());
  std::uint64_t tick = 0;
  for (; tick < 400; ++tick) {
    publish(tick);
    acknowledge_all(quick);
    // Each viewer takes one frame per 60 ms (one in three ticks), and they do so at different
    // times.
    for (std::size_t i = 0; i < slow.size(); ++i) {
      const auto frames = slow[i].connection->frames();
      if (tick % 3 != i || acknowledged[i] >= frames.size()) continue;
      EXPECT_TRUE(slow[i].outbox->acknowledge(frames[acknowledged[i]++].header.number, now));
      delivery.retry(std::exchange(wakes->clients, {}), now);
    }
  }
  for (const TestViewer& viewer : slow) {
    std::size_t few = 0;
    std::size_t together = 0;
    for (const GridFrame& frame : viewer.connection->frames()) {
      if (frame.header.stride < 4) continue;
      ++few;
      if (frame.header.tick % 4 == 0) ++together;
    }
    EXPECT_GT(few, 20U) << "each viewer can receive a quarter of the rate";
    EXPECT_GT(4 * together, 3 * few) << "most frames are on common ticks";
  }
  EXPECT_EQ(quick.last().stride, 1U);
  EXPECT_EQ(quick.ticks().size(), 400U);
}

TEST_F(FrameDeliveryTest, ALimitedViewerReceivesTheStateAtThePause) {
  const TestViewer slow = add();
  std::uint64_t tick = 1;
  for (; slow.connection->frames().empty() || slow.last().stride < 4; ++tick) {
    ASSERT_LT(tick, 1000U);
    publish(tick);
    if (tick % 12 == 0) acknowledge_all(slow);
  }
  for (acknowledge_all(slow); tick % 4 != 2; ++tick) {
    publish(tick);
    acknowledge_all(slow);
  }
  publish(tick, 0.9);
  EXPECT_LT(slow.last().tick, tick) << "the viewer's turn comes later";
  publish(tick, 0.9, false);
  EXPECT_EQ(slow.last().tick, tick);
}

// An eighth of a small body would not show its shape, and its frames are short anyway.
TEST_F(FrameDeliveryTest, ASlowViewerReceivesAllFramesOfFewParticles) {
  for (const auto& [count, least] : {std::pair(1000U, 3), std::pair(16000U, 0)}) {
    particles = count;
    const TestViewer slow = add();
    for (std::uint64_t tick = 1; tick < 1000; ++tick) {
      publish(tick);
      if (tick % 12 == 0) acknowledge_all(slow);
    }
    EXPECT_EQ(slow.connection->frames().back().detail, least) << count;
    EXPECT_EQ(slow.last().stride, 4U);
  }
}

// After dropped, skipped and late frames, each received frame decodes from the frames before it,
// and shows the state of its tick.
TEST_F(FrameDeliveryTest, EveryPathThroughTheFramesShowsTheSame) {
  std::mt19937 random(1);
  std::vector<TestViewer> viewers;
  std::map<std::uint64_t, std::vector<std::uint16_t>> shown;  // by tick, on the finest grid
  for (std::uint64_t tick = 1; tick <= 300; ++tick) {
    if (random() % 10 == 0) viewers.push_back(add(every(1 + random() % 3)));
    publish(tick);
    for (const TestViewer& viewer : viewers) {
      if (random() % 3 > 0 && !viewer.ticks().empty()) acknowledge_all(viewer);
    }
  }
  std::size_t frames = 0;
  for (const TestViewer& viewer : viewers) {
    for (const GridFrame& frame : viewer.connection->frames()) {
      if (frame.scale.grid.quantum > 2e-5 || frame.detail != kFullDetail) continue;
      const auto& positions = frame.blocks.at(0).positions;
      const auto first = shown.emplace(frame.header.tick, positions).first;
      EXPECT_EQ(positions, first->second) << "tick " << frame.header.tick;
      ++frames;
    }
  }
  EXPECT_GT(frames, 1000U);
}

}  // namespace
}  // namespace vat::test::frame_delivery_test
