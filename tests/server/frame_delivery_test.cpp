#include "server/session/frame_delivery.h"

#include <gtest/gtest.h>

#include "tests/server/fake_connection.h"

namespace vat::test {
namespace {

class Wakes final : public FrameWaker {
 public:
  void wake(ConnectionId client) override { clients.push_back(client); }
  std::vector<ConnectionId> clients;
};

/// A viewer, and what it has got.
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
    delivery.add(viewer.outbox, viewer.outbox->subscribe(membership, wakes), wish);
    return viewer;
  }
  /// One in which something has moved since all others.
  void publish(std::uint64_t tick) { publish(tick, 1e-3 * static_cast<double>(++states_)); }
  void publish(std::uint64_t tick, double x) {
    PublishedState state;
    state.header.epoch = kEpoch;
    state.header.tick = tick;
    state.bodies.resize(1);
    state.bodies[0].id = 1;
    state.bodies[0].positions = {{x, 0.5, 0.5}};
    delivery.publish(std::move(state));
  }
  void acknowledge_all(const TestViewer& viewer) {
    EXPECT_TRUE(viewer.outbox->acknowledge(viewer.last().number));
    delivery.retry(std::exchange(wakes->clients, {}));
  }

  ServerMetrics metrics;
  const std::shared_ptr<Wakes> wakes = std::make_shared<Wakes>();
  FrameDelivery delivery{Vat{Vec3::Zero(), Vec3::Ones(), true, {}}, metrics};

 private:
  ConnectionId last_id_ = 0;
  int states_ = 0;
};

using Ticks = std::vector<std::uint64_t>;

TEST_F(FrameDeliveryTest, AViewerGetsTheTicksThatItAskedFor) {
  const TestViewer all = add();
  const TestViewer third = add({0, 3});
  for (std::uint64_t tick = 1; tick <= 7; ++tick) {
    publish(tick);
    acknowledge_all(all);
    acknowledge_all(third);
  }
  EXPECT_EQ(all.ticks(), (Ticks{1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(third.ticks(), (Ticks{1, 3, 6})) << "the first at once";
}

// The tick that it divides may never come here: a newer state has taken its place.
TEST_F(FrameDeliveryTest, ATurnThatWasSkippedComesWithTheNextState) {
  const TestViewer third = add({0, 3});
  for (const std::uint64_t tick : {1, 2, 4, 5, 7, 8}) {
    publish(tick);
    acknowledge_all(third);
  }
  EXPECT_EQ(third.ticks(), (Ticks{1, 4, 7}));
}

TEST_F(FrameDeliveryTest, WhoIsNotReadyGetsTheNewestOnceItIs) {
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
  EXPECT_EQ(slow.last().number, 50u) << "4 to 49 are left out";
  acknowledge_all(slow);
  EXPECT_EQ(slow.ticks().size(), 4u) << "there is nothing new";
}

TEST_F(FrameDeliveryTest, WhatShowsNothingNewIsLeftOut) {
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

TEST_F(FrameDeliveryTest, WhoComesToAStateAtRestGetsIt) {
  const TestViewer first = add();
  publish(1, 0.5);
  acknowledge_all(first);
  const TestViewer second = add();
  publish(1, 0.5);
  EXPECT_EQ(second.ticks(), (Ticks{1}));
  EXPECT_EQ(first.ticks(), (Ticks{1}));
}

TEST_F(FrameDeliveryTest, AnEpochBeginsWithAFrameForAll) {
  const TestViewer third = add({0, 3});
  publish(4);
  acknowledge_all(third);
  delivery.set_vat({});
  publish(0);
  EXPECT_EQ(third.ticks(), (Ticks{4, 0}));
}

TEST_F(FrameDeliveryTest, WhoWasRemovedGetsNothing) {
  const TestViewer viewer = add();
  publish(1);
  delivery.remove(1);
  publish(2);
  delivery.retry(std::vector<ConnectionId>{1, 7});
  EXPECT_EQ(viewer.ticks(), (Ticks{1}));
}

}  // namespace
}  // namespace vat::test
