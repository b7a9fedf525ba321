// Frames and events: who gets which, how old, and at whose cost.

#include <cmath>

#include "tests/server/session_fixture.h"

namespace vat::test::session_frames_test {
namespace {

class SessionFrames : public SessionTest {
 protected:
  /// Frames once those of the present state have gone to all: those of one state go out one client
  /// after the other, so that a later subscriber's is the last.
  std::vector<GridFrame> frames(TestClient& reader) {
    const auto last = join();
    last->result("frames.subscribe");
    last->wait_frame([](const GridFrame&) { return true; });
    return reader.connection->frames();
  }
};

TEST_F(SessionFrames, ASubscriberGetsThePresentStateAtOnce) {
  client->result("control.step", {{"ticks", 2}});
  client->result("frames.subscribe");
  const GridFrame frame = client->wait_frame([](const GridFrame&) { return true; });
  EXPECT_EQ(frame.header.tick, 2u);
  EXPECT_EQ(frame.header.number, 1u);
  EXPECT_DOUBLE_EQ(frame.header.time, 0.04);
  EXPECT_EQ(frame.header.epoch, 2u);
  ASSERT_EQ(frame.blocks.size(), 4u);
  EXPECT_EQ(frame.blocks[0].kind, GridBlock::Kind::vat);
  EXPECT_EQ(frame.blocks[3].body, 3u);
}

TEST_F(SessionFrames, AnErrorBoundIsKept) {
  client->result("frames.subscribe", {{"max_error", 1e-3}});
  const GridFrame frame = client->wait_frame([](const GridFrame&) { return true; });
  EXPECT_DOUBLE_EQ(frame.scale.grid.quantum, 2e-3);
  const Json state = client->result("state.query", {{"bodies", {"pool"}}});
  const Json& positions = state.at("bodies").at(0).at("positions");
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double sent = frame.scale.grid.origin[axis] +
                          frame.scale.grid.quantum * frame.blocks[1].positions[3 * i + axis];
      EXPECT_NEAR(sent, positions[i][axis].get<double>(), 1e-3 * (1 + 1e-9));
    }
  }
}

// The fixture's deformable cube and its pool have particles at 0.1 m.
TEST_F(SessionFrames, WithoutAnErrorBoundItGoesByTheFinestParticles) {
  const auto quantum = [this](const Json& params) {
    client->result("frames.subscribe", params);
    const std::uint32_t tick = client->result("control.step").at("tick").get<std::uint32_t>();
    return client->wait_frame([=](const GridFrame& f) { return f.header.tick == tick; })
        .scale.grid.quantum;
  };
  const double usual = 2 * 0.1 / 64;
  EXPECT_DOUBLE_EQ(quantum(Json::object()), usual);
  const Json ball = {{"name", "marble"},
                     {"kind", "rigid"},
                     {"material", "wood"},
                     {"spacing", 0.02},
                     {"shape", {{"type", "sphere"}, {"radius", 0.04}}},
                     {"position", {0.2, 0.8, 0.8}}};
  client->result("world.add_body", {{"body", ball}});
  EXPECT_DOUBLE_EQ(quantum(Json::object()), usual) << "a rigid body has a pose";
  Json block = ball;
  block["name"] = "block";
  block["kind"] = "deformable";
  block["material"] = "rubber";
  block["spacing"] = 0.05;
  block["shape"] = {{"type", "box"}, {"center", {0, 0, 0}}, {"size", {0.1, 0.1, 0.1}}};
  block["position"] = {0.8, 0.2, 0.8};
  client->result("world.add_body", {{"body", block}});
  EXPECT_DOUBLE_EQ(quantum(Json::object()), usual / 2);
  EXPECT_LT(quantum({{"max_error", 0}}), usual / 10);
}

TEST_F(SessionFrames, AttributesComeWhereTheyAreAskedFor) {
  client->result("control.step", {{"ticks", 5}});
  client->result("frames.subscribe", {{"attributes", {{"speed", 1e-3}, {"density", 0.5}}}});
  const GridFrame frame = client->wait_frame([](const GridFrame&) { return true; });
  EXPECT_EQ(frame.scale.attribute_quanta, (ByAttribute<double>{2e-3, 1, 0, 0}));
  const GridBlock& pool = frame.blocks.at(1);
  const Json state = client->result("state.query", {{"bodies", {"pool"}}});
  const Json& velocities = state.at("bodies").at(0).at("velocities");
  ASSERT_EQ(pool.attributes[0].size(), velocities.size());
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    const double speed = std::hypot(velocities[i][0].get<double>(), velocities[i][1].get<double>(),
                                    velocities[i][2].get<double>());
    EXPECT_NEAR(2e-3 * pool.attributes[0][i], speed, 1e-3 + 1e-7) << "and a float's rounding";
  }
  EXPECT_EQ(pool.attributes[1].size(), velocities.size());
  EXPECT_TRUE(pool.attributes[2].empty());
}

// What nothing touches falls: with the acceleration of gravity over each tick.
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
  EXPECT_EQ(cube_at(0), 0) << "no tick was run";
  client->result("control.step");
  EXPECT_NEAR(cube_at(1), 5, 1.1e-3);
  client->result("world.set_gravity", {{"gravity", {3, 0, -4}}});
  client->result("control.step", {{"ticks", 2}});
  EXPECT_NEAR(cube_at(3), 5, 1.1e-3);
  client->result("world.set_gravity", {{"gravity", {0, 0, -1}}});
  client->result("control.step");
  EXPECT_NEAR(cube_at(4), 1, 1.1e-3);
}

TEST_F(SessionFrames, OnlyTheParticlesThatAreAskedForCome) {
  client->result("frames.subscribe", {{"detail", 1}});
  const GridFrame few = client->wait_frame([](const GridFrame&) { return true; });
  EXPECT_EQ(few.detail, 1);
  const GridBlock& pool = few.blocks.at(1);
  ASSERT_GT(pool.particle_count(), 0U);
  for (std::size_t i = 0; i < pool.particle_count(); ++i)
    EXPECT_LE(detail_layer(pool.number(i)), 1);
  client->result("frames.subscribe",
                 {{"region", {{"min", {0, 0, 0}}, {"max", {0.45, 0.45, 0.23}}}}});
  const GridFrame part = client->wait_frame([](const GridFrame& f) { return f.has_region; });
  const Json state = client->result("state.query", {{"bodies", {"pool"}}});
  std::size_t inside = 0;
  for (const Json& p : state.at("bodies").at(0).at("positions")) {
    inside += p[0] <= 0.45 && p[1] <= 0.45 && p[2] <= 0.23 ? 1 : 0;
  }
  EXPECT_EQ(part.blocks.at(1).particle_count(), inside);
  EXPECT_EQ(part.blocks.at(3).kind, GridBlock::Kind::rigid)
      << "bodies of one pose are always there";
}

TEST_F(SessionFrames, OnlyEachSoManiethTickIsSent) {
  const auto other = join();
  client->result("frames.subscribe", {{"every", 5}});
  other->result("frames.subscribe", {{"every", 1}});
  other->wait_frame([](const GridFrame&) { return true; });
  std::vector<std::uint64_t> ticks;
  std::size_t all = 0;
  for (int i = 0; i < 20; ++i) {
    const std::uint64_t tick = client->result("control.step").at("tick");
    other->wait_frame([&](const GridFrame& frame) { return frame.header.tick == tick; });
    ++all;
    for (const GridFrame& frame : frames(*client)) {
      if (ticks.empty() || frame.header.tick > ticks.back()) {
        ticks.push_back(frame.header.tick);
        client->notify("frames.ack", {{"number", frame.header.number}});
      }
    }
  }
  EXPECT_EQ(ticks, (std::vector<std::uint64_t>{0, 5, 10, 15, 20}));
  EXPECT_EQ(all, 20u);
}

TEST_F(SessionFrames, NothingIsEncodedForNobody) {
  client->result("control.step", {{"ticks", 20}});
  EXPECT_NE(server.metrics().find("\nvat_frames_encoded_total 0\n"), std::string::npos);
  client->result("frames.subscribe");
  client->wait_frame([](const GridFrame&) { return true; });
  EXPECT_NE(server.metrics().find("\nvat_frames_encoded_total 1\n"), std::string::npos);
}

TEST_F(SessionFrames, AnUnsubscribedClientGetsNone) {
  client->result("frames.subscribe");
  client->wait_frame([](const GridFrame&) { return true; });
  client->result("frames.unsubscribe");
  client->result("control.step", {{"ticks", 5}});
  EXPECT_EQ(frames(*client).size(), 1u);
  client->result("frames.subscribe");
  client->wait_frame([](const GridFrame& f) { return f.header.tick == 5; });
}

TEST_F(SessionFrames, ASlowClientGetsTheNewestAndHindersNobody) {
  const auto slow = join();
  slow->result("frames.subscribe");
  client->result("frames.subscribe");
  client->wait_frame([](const GridFrame&) { return true; });
  frames(*slow);  // it has the first, too
  for (int i = 1; i <= 100; ++i) {
    const std::uint64_t tick = client->result("control.step").at("tick");
    client->wait_frame([&](const GridFrame& f) { return f.header.tick == tick; });
  }
  ASSERT_EQ(frames(*slow).size(), 3u) << "the window";
  slow->notify("frames.ack", {{"number", 3}});
  slow->connection->wait_frames(4);
  const std::vector<GridFrame> all = frames(*slow);
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all.back().header.tick, 100u);
  // The first three are those of ticks 0, 1 and 2; 3 to 99 went, and the numbers tell.
  EXPECT_EQ(all[2].header.number, 3u);
  EXPECT_EQ(all.back().header.number, 101u);
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
    EXPECT_GE(reply.at("tick"), frame.header.tick) << "no earlier than what it has seen";
  }
  client->result("session.leave");
  EXPECT_EQ(client->result("frames.ack", {{"number", 1}}), Json::object());
}

TEST_F(SessionFrames, AClientThatReadsNothingIsClosedAndTheOthersGoOn) {
  const auto dead = join();
  dead->result("frames.subscribe");
  dead->connection->stall(true);
  const std::string title(4000, 't');
  Json scene = Json::parse(mixed_scene_text());
  scene["title"] = title;
  for (int i = 0; i < 400 && !dead->connection->close_code(); ++i) {
    client->result("scene.load", {{"scene", scene}});  // a description for all
  }
  dead->connection->wait_closed();
  EXPECT_EQ(dead->connection->close_code(), 4008);
  EXPECT_LE(dead->connection->queued(), std::size_t{2} << 20) << "control queue and three frames";
  dead->disconnect();
  EXPECT_EQ(client->result("control.step", {{"ticks", 2}}).at("tick"), 2);
  EXPECT_FALSE(client->connection->close_code().has_value());
}

TEST_F(SessionFrames, NoFrameOfAnEndedEpochComesAfterTheDescription) {
  client->result("frames.subscribe");
  for (int i = 0; i < 10; ++i) {
    client->result("control.step", {{"ticks", 10}});  // the window fills, one frame is missed
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

TEST_F(SessionFrames, ManyChangesAtOnceMakeFewDescriptions) {
  std::vector<int> ids;
  for (int i = 0; i < 40; ++i) ids.push_back(client->send("control.reset"));
  client->wait_reply(ids.back());
  client->result("session.hash");
  client->wait_event("session.description", [](const Json& d) { return d.at("epoch") == 42; });
  EXPECT_LE(client->events("session.description").size(), 40u);
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
  static ServerLimits limits() {
    ServerLimits limits;
    limits.frame_patience = std::chrono::seconds(1);
    return limits;
  }
  SessionPatience() : SessionTest(limits()) {}
};

// Also where nothing moves: a frame was sent, and nobody knows whether it came.
TEST_F(SessionPatience, WhoAcknowledgesNothingIsToldAndClosed) {
  client->result("frames.subscribe");
  client->wait_frame([](const GridFrame&) { return true; });
  const auto silent = join();
  silent->result("frames.subscribe");
  silent->connection->wait_closed();
  EXPECT_EQ(silent->connection->close_code(), 4008);
  EXPECT_FALSE(client->connection->close_code().has_value());
}

}  // namespace
}  // namespace vat::test::session_frames_test
