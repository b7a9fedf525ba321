// Delivery of frames and events in a session.

#include "server/frames/frame_feed.h"
#include "server/messages/limits.h"
#include "server/session/core/session_core.h"
#include "tests/server/fixture/session_fixture.h"
#include "tests/support/lone_environment.h"

namespace vat::test::session_frames_test {
namespace {

class SessionFrames : public SessionTest {};

TEST_F(SessionFrames, FollowTheSubscription) {
  client->result("control.step", {{"ticks", 5}});
  client->result("frames.subscribe", {{"every", 5},
                                      {"max_error", 1e-3},
                                      {"detail", 2},
                                      {"region", {{"min", {0, 0, 0}}, {"max", {1, 1, 0.5}}}},
                                      {"attributes", {{"speed", 1e-3}, {"density", 0.5}}}});
  const GridFrame frame = client->wait_frame([](const GridFrame&) { return true; });
  EXPECT_EQ(frame.header.tick, 5U) << "the current state is sent immediately";
  EXPECT_EQ(frame.header.number, 1U);
  EXPECT_EQ(frame.header.epoch, 2U);
  EXPECT_DOUBLE_EQ(frame.header.time, 0.1);
  EXPECT_DOUBLE_EQ(frame.scale.grid.quantum, 2e-3);
  EXPECT_EQ(frame.detail, 2);
  EXPECT_TRUE(frame.has_region);
  EXPECT_EQ(frame.scale.attribute_quanta, (ByAttribute<double>{2e-3, 1, 0, 0}));
  ASSERT_EQ(frame.blocks.size(), 4U);
  EXPECT_EQ(frame.blocks[0].kind, GridBlock::Kind::vat);
  const std::size_t particles = frame.blocks[1].particle_count();
  EXPECT_EQ(frame.blocks[1].attributes[0].size(), particles);
  EXPECT_EQ(frame.blocks[1].attributes[1].size(), particles);
  client->result("control.step", {{"ticks", 3}});
  client->result("control.step", {{"ticks", 2}});
  EXPECT_EQ(client->wait_frame([](const GridFrame& f) { return f.header.tick > 5; }).header.tick,
            10U);
}

// The fixture's cube and pool have a particle spacing of 0.1 m.
TEST_F(SessionFrames, WithoutAnErrorBoundItGoesByTheFinestParticles) {
  const auto quantum = [this](const Json& params) {
    client->result("frames.subscribe", params);
    const std::uint32_t tick = client->result("control.step").at("tick").get<std::uint32_t>();
    return client->wait_frame([=](const GridFrame& f) { return f.header.tick == tick; })
        .scale.grid.quantum;
  };
  const double usual = 2 * 0.1 / 64;
  EXPECT_DOUBLE_EQ(quantum(Json::object()), usual);
  Json ball = wooden_ball("ball 2", {0.2, 0.8, 0.8});
  ball["spacing"] = 0.02;
  client->result("world.add_body", {{"body", ball}});
  EXPECT_DOUBLE_EQ(quantum(Json::object()), usual) << "a rigid body is sent as a pose";
  Json block = Json::parse(mixed_scene_text()).at("bodies").at(1);  // the cube
  block["name"] = "block";
  block["spacing"] = 0.05;
  block["position"] = {0.5, -0.1, 0.2};
  client->result("world.add_body", {{"body", block}});
  EXPECT_DOUBLE_EQ(quantum(Json::object()), usual / 2);
  EXPECT_LT(quantum({{"max_error", 0}}), usual / 10);
}

// In free fall, the acceleration equals gravity in each tick.
TEST_F(SessionFrames, AccelerationsAreThoseOfTheLastTick) {
  client->result("world.set_gravity", {{"gravity", {0, 0, -5}}});
  client->result("frames.subscribe", {{"attributes", {{"acceleration", 1e-3}}}});
  const auto cube_at = [&](std::uint64_t tick) {
    const GridFrame frame =
        client->wait_frame([&](const GridFrame& f) { return f.header.tick == tick; });
    EXPECT_EQ(frame.scale.attribute_quanta, (ByAttribute<double>{0, 0, 0, 2e-3}));
    const GridBlock& cube = frame.blocks.at(2);
    EXPECT_EQ(cube.attributes[3].size(), cube.particle_count());
    return cube.attributes[3].empty() ? 0 : 2e-3 * cube.attributes[3].at(0);
  };
  EXPECT_EQ(cube_at(0), 0) << "no tick has run";
  client->result("control.step");
  EXPECT_NEAR(cube_at(1), 5, 1.1e-3);
  client->result("world.set_gravity", {{"gravity", {3, 0, -4}}});
  client->result("control.step", {{"ticks", 2}});
  EXPECT_NEAR(cube_at(3), 5, 1.1e-3);
  client->result("world.set_gravity", {{"gravity", {0, 0, -1}}});
  client->result("control.step");
  EXPECT_NEAR(cube_at(4), 1, 1.1e-3);
}

// More clients with different frames than the server encodes for one state.
TEST_F(SessionFrames, APausedSessionServesEveryClient) {
  std::vector<std::unique_ptr<TestClient>> clients;
  for (std::size_t i = 0; i < kMaxFrameGroups + 2; ++i) {
    clients.push_back(join());
    clients.back()->result("frames.subscribe", {{"max_error", 1e-5 * static_cast<double>(i + 1)}});
    clients.back()->wait_frame([](const GridFrame&) { return true; });
  }
  client->result("control.step");
  for (const auto& one : clients) {
    one->wait_frame([](const GridFrame& frame) { return frame.header.tick == 1; });
  }
}

TEST_F(SessionFrames, AnUnsubscribedClientGetsNone) {
  client->result("control.step", {{"ticks", 20}});
  EXPECT_TRUE(has_sample(server.metrics(), "vat_frames_encoded_total 0"));
  client->result("frames.subscribe");
  client->wait_frame([](const GridFrame&) { return true; });
  EXPECT_TRUE(has_sample(server.metrics(), "vat_frames_encoded_total 1"));
  client->result("frames.unsubscribe");
  client->result("control.step", {{"ticks", 5}});
  const auto other = join();  // the frame of a later subscriber is the last of a state
  other->result("frames.subscribe");
  other->wait_frame([](const GridFrame&) { return true; });
  EXPECT_EQ(client->connection->frames().size(), 1u);
  client->result("frames.subscribe");
  client->wait_frame([](const GridFrame& f) { return f.header.tick == 25; });
}

TEST_F(SessionFrames, AnAcknowledgementNamesTheTickWhileThereIsASession) {
  client->result("frames.subscribe");
  client->send("control.play");
  std::uint32_t last = 0;
  for (int i = 0; i < 20; ++i) {
    const GridFrame frame =
        client->wait_frame([&](const GridFrame& f) { return f.header.number > last; });
    last = frame.header.number;
    const Json reply = client->result("frames.ack", {{"number", last}});
    EXPECT_GE(reply.at("tick"), frame.header.tick) << "not earlier than the last frame seen";
  }
  client->result("session.leave");
  EXPECT_EQ(client->result("frames.ack", {{"number", 1}}), Json::object());
}

TEST_F(SessionFrames, NoFrameOfAnEndedEpochFollowsTheDescription) {
  client->result("frames.subscribe");
  for (int i = 0; i < 10; ++i) {
    client->result("control.step", {{"ticks", 10}});  // the window fills, so one frame is omitted
    client->mark();
    client->result("control.reset");
    const Json description = client->wait_event("session.description");
    const std::size_t before = client->connection->frames().size();
    const GridFrame first = client->wait_frame(
        [&](const GridFrame& frame) { return frame.header.epoch == description.at("epoch"); });
    EXPECT_EQ(first.header.tick, 0u);
    const auto all = client->connection->frames();
    for (std::size_t f = before; f < all.size(); ++f) {
      EXPECT_EQ(all[f].header.epoch, description.at("epoch"));
    }
  }
}

TEST_F(SessionFrames, StatusesComeWithoutChangesToo) {
  const Json status = client->wait_event("session.status");
  EXPECT_EQ(status.at("clients"), 1);
  EXPECT_EQ(status.at("playing"), false);
  EXPECT_EQ(status.at("tick"), 0);
  EXPECT_EQ(status.at("time"), 0);
  EXPECT_EQ(status.at("speed"), 1);
  EXPECT_GT(status.at("particles"), 0);
}

class SessionPatience : public SessionTest {
 protected:
  SessionPatience()
      : SessionTest(limits_with(&ServerLimits::frame_patience, std::chrono::seconds(1))) {}
};

// Applies also to a state at rest: the server sent a frame and does not know whether it arrived.
TEST_F(SessionPatience, AClientWithoutAcknowledgementsIsNotifiedAndClosed) {
  client->result("frames.subscribe");
  client->wait_frame([](const GridFrame&) { return true; });
  const auto silent = join();
  silent->result("frames.subscribe");
  server.flush();
  server.clock().advance(std::chrono::milliseconds(500));
  EXPECT_FALSE(silent->connection->close_code().has_value());
  server.clock().advance(std::chrono::milliseconds(1000));
  EXPECT_EQ(silent->connection->close_code(), 4008);
  EXPECT_FALSE(client->connection->close_code().has_value());
}

class SessionCoreTest : public testing::Test {
 protected:
  std::shared_ptr<FakeConnection> subscribe() {
    const auto connection = std::make_shared<FakeConnection>(viewers_.size() + 1);
    const auto outbox = std::make_shared<ClientOutbox>(connection);
    viewers_.emplace_back(connection, outbox);
    core.people().join(outbox, outbox->join(), {}, now);
    core.notifier().subscribe(*core.participants().find_client(connection->id()), {}, now);
    core.notifier().announce();
    wait();
    return connection;
  }
  /// Runs a tick. All clients acknowledge their frames.
  void tick() {
    ASSERT_TRUE(core.tick(now, true));
    core.notifier().publish_tick();
    wait();
    for (const auto& [connection, outbox] : viewers_) {
      ASSERT_TRUE(outbox->acknowledge(connection->frames().back().header.number, now));
    }
  }
  /// Waits until the frame threads have executed all posted tasks.
  void wait() {
    std::promise<void> done;
    boost::asio::post(environment.shared.frame_threads, [&] { done.set_value(); });
    done.get_future().wait();
  }
  bool counted(const std::string& sample) const {
    return has_sample(environment.shared.metrics.to_text({}), sample);
  }

  const LoneEnvironment environment;
  const SteadyClock::time_point now = environment.clock.now();
  SessionCore core{"s1", {"one"}, mixed_simulation(), environment.shared};

 private:
  std::vector<std::pair<std::shared_ptr<FakeConnection>, std::shared_ptr<ClientOutbox>>> viewers_;
};

// The second frame of each client refers to one frame, the following frames to two, as those of the
// other clients do.
TEST_F(SessionCoreTest, NewcomersBetweenTwoTicksShareAKeyFrame) {
  const auto first = subscribe();
  tick();
  tick();
  tick();
  EXPECT_TRUE(counted("vat_frames_encoded_total 3"));
  const auto second = subscribe();
  const auto third = subscribe();
  EXPECT_TRUE(second->frames().empty()) << "the frame is sent with the next tick";
  tick();
  EXPECT_TRUE(counted("vat_key_frames_encoded_total 2")) << "one key frame for both clients";
  EXPECT_TRUE(counted("vat_frames_encoded_total 5"));
  for (const auto& connection : {first, second, third}) {
    ASSERT_FALSE(connection->frames().empty());
    EXPECT_EQ(connection->frames().back().header.tick, 4U);
  }
}

constexpr std::uint32_t kEpoch = 1;

PublishedState make_state(std::uint64_t tick, bool has_speeds) {
  PublishedState state;
  state.header.epoch = kEpoch;
  state.header.tick = tick;
  state.bodies.resize(1);
  state.bodies[0].id = 1;
  state.bodies[0].positions = {{0.1, 0.2, 0.3}};
  if (has_speeds) state.bodies[0].attributes[0] = {2.0F};
  return state;
}

/// Blocks the only thread of the pool.
class Block {
 public:
  explicit Block(boost::asio::thread_pool& pool) {
    boost::asio::post(pool, [released = released_.get_future().share()] { released.wait(); });
  }
  void release() { released_.set_value(); }

 private:
  std::promise<void> released_;
};

// A waiting state was published for the previous subscribers.
TEST(FrameFeed, SendsNoStateWithoutTheRequestedAttributes) {
  ServerMetrics metrics;
  const ManualClock clock;
  boost::asio::thread_pool pool(1);
  const auto feed = std::make_shared<FrameFeed>("s1", std::nullopt, metrics, pool, clock);
  const auto connection = std::make_shared<FakeConnection>(1);
  const auto outbox = std::make_shared<ClientOutbox>(connection);
  const std::uint64_t membership = outbox->join();
  outbox->start_epoch(membership, kEpoch);
  Subscription wish;
  wish.attribute_errors[0] = 0.01;

  Block block(pool);
  PublishedState state = make_state(7, false);
  feed->publish(state);
  EXPECT_TRUE(feed->add(outbox, outbox->subscribe(membership, feed, clock.now()), wish))
      << "a further state should be published";
  block.release();
  std::promise<void> done;
  boost::asio::post(pool, [&] { done.set_value(); });
  done.get_future().wait();
  EXPECT_TRUE(connection->frames().empty());

  state = make_state(8, true);
  feed->publish(state);
  pool.join();
  ASSERT_EQ(connection->frames().size(), 1U);
  EXPECT_EQ(connection->frames()[0].header.tick, 8U);
}

// Four states are in use: one is being filled, one waits, one was taken from the queue, and one is
// shown. From the fifth on, a tick reuses the memory of an earlier state.
TEST(FrameFeed, FourStatesGoRound) {
  constexpr std::size_t kParticles = 1000;
  ServerMetrics metrics;
  const ManualClock clock;
  boost::asio::thread_pool pool(1);
  const auto feed = std::make_shared<FrameFeed>("s1", std::nullopt, metrics, pool, clock);
  PublishedState state;
  for (std::uint64_t tick = 1; tick <= 100; ++tick) {
    if (tick > 4) {
      ASSERT_EQ(state.bodies.size(), 1U);
      ASSERT_GE(state.bodies[0].positions.capacity(), kParticles);
    }
    state.header = {.epoch = kEpoch, .tick = tick};
    state.bodies.resize(1);
    state.bodies[0].positions.assign(kParticles, Vec3(0, 0, 1e-3 * static_cast<double>(tick)));
    feed->publish(state);
    if (tick % 3 == 0) continue;  // the next state may replace a waiting one
    std::promise<void> done;
    boost::asio::post(pool, [&] { done.set_value(); });
    done.get_future().wait();
  }
  pool.join();
}

}  // namespace
}  // namespace vat::test::session_frames_test
