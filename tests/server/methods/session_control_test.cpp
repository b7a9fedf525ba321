// control.*: play, pause, step, reset and speed.

#include "tests/server/fixture/session_fixture.h"

namespace vat::test::session_control_test {
namespace {

class SessionControl : public SessionTest {
 protected:
  Json wait_status(const std::function<bool(const Json&)>& fits) {
    return client->wait_event("session.status", fits);
  }
  void play_fast() {
    client->result("control.set_speed", {{"speed", 4}});
    client->result("frames.subscribe");
    client->result("control.play");
  }
};

TEST_F(SessionControl, APausedSessionStays) {
  play_fast();
  client->wait_frame([](const GridFrame& frame) { return frame.header.tick >= 2; });
  const std::uint64_t end = client->result("control.pause").at("tick");
  const std::string before = hash();
  EXPECT_EQ(client->result("control.pause").at("tick"), end) << "again";
  client->mark();
  wait_status([](const Json& status) { return status.at("playing") == false; });
  // The status arrives every half second. Ticks of 5 ms would send many more.
  wait_status([&](const Json& status) { return status.at("tick") == end; });
  EXPECT_EQ(hash(), before);
  client->result("control.step");
  const GridFrame last =
      client->wait_frame([&](const GridFrame& f) { return f.header.tick == end + 1; });
  EXPECT_FALSE(last.header.playing);
}

TEST_F(SessionControl, AStepWhilePlayingPausesFirst) {
  play_fast();
  const GridFrame frame = client->wait_frame([](const GridFrame& f) { return f.header.tick >= 2; });
  EXPECT_TRUE(frame.header.playing);
  const Json reply = client->result("control.step", {{"ticks", 4}});
  EXPECT_GE(reply.at("tick"), frame.header.tick + 4);
  EXPECT_EQ(tick(), reply.at("tick"));
  const Json description = client->result("session.join").at("description");
  EXPECT_EQ(description.at("playing"), false);
  EXPECT_EQ(description.at("tick"), reply.at("tick"));
}

TEST_F(SessionControl, ResetGivesTheBitsOfAFreshSession) {
  const std::string fresh = hash();
  client->result("world.set_gravity", {{"gravity", {3, 0, 0}}});
  client->result("world.apply_force", {{"body", 3}, {"force", {9, 0, 0}}, {"duration", 100}});
  client->result("grab.start", {{"body", 2}, {"particle", 0}, {"target", {0.5, 0.5, 0.9}}});
  client->result("world.remove_body", {{"body", 1}});
  client->result("control.step", {{"ticks", 10}});
  EXPECT_NE(hash(), fresh);
  EXPECT_EQ(client->result("control.reset").at("tick"), 0);
  EXPECT_EQ(hash(), fresh);
  EXPECT_EQ(client->result("session.hash").at("time"), 0);

  client->result("control.step", {{"ticks", 10}});
  EXPECT_EQ(hash(), mixed_hash_after(10)) << "no force, grab or changed gravity remains";
}

TEST_F(SessionControl, ResetKeepsPlaying) {
  play_fast();
  client->wait_frame([](const GridFrame& frame) { return frame.header.tick >= 5; });
  client->mark();
  client->result("control.reset");
  const Json description = client->wait_event("session.description");
  EXPECT_EQ(description.at("playing"), true);
  EXPECT_EQ(description.at("tick"), 0);
  client->wait_frame([&](const GridFrame& frame) {
    return frame.header.epoch == description.at("epoch") && frame.header.tick >= 2;
  });
}

TEST_F(SessionControl, AControlCommandOfAnotherEndsAStep) {
  const auto other = join();
  const int step = client->send("control.step", {{"ticks", 1000}});
  const std::uint64_t end = other->result("control.pause").at("tick");
  EXPECT_EQ(client->wait_reply(step).at("result").at("tick"), end);
  EXPECT_LT(end, 1000u);
  EXPECT_EQ(tick(), end);
}

TEST_F(SessionControl, StepsOfTwoClientsAddUp) {
  const auto other = join();
  const int first = client->send("control.step", {{"ticks", 30}});
  const int second = other->send("control.step", {{"ticks", 40}});
  EXPECT_EQ(client->wait_reply(first).at("result").at("tick"), 30);
  EXPECT_EQ(other->wait_reply(second).at("result").at("tick"), 70);
}

TEST_F(SessionControl, AStepOfAClientThatGoesEnds) {
  auto other = join();
  other->send("control.step", {{"ticks", 1000}});
  other->disconnect();
  EXPECT_LT(client->result("control.step").at("tick"), 1000);
  const std::uint64_t now = tick();
  EXPECT_EQ(client->result("control.step").at("tick"), now + 1);
}

// At four times the speed, ticks of 0.02 s are due every 5 ms.
TEST_F(SessionControl, PlaysAtItsSpeed) {
  client->result("control.set_speed", {{"speed", 4}});
  const Json status = wait_status([](const Json& s) { return s.at("speed") == 4; });
  EXPECT_EQ(status.at("real_time_factor"), 0);
  client->result("control.play");
  client->result("control.play");  // again
  server.clock().advance(std::chrono::milliseconds(199));
  EXPECT_EQ(tick(), 39U);
  server.clock().advance(std::chrono::milliseconds(1));
  EXPECT_EQ(tick(), 40U);
  wait_status([](const Json& s) { return s.at("real_time_factor") > 3.9; });
  const std::uint64_t before = tick();
  client->result("control.set_speed", {{"speed", 0.5}});
  server.clock().advance(std::chrono::milliseconds(400));
  EXPECT_EQ(tick(), before + 10);
  client->result("control.pause");
  server.clock().advance(std::chrono::seconds(1));
  EXPECT_EQ(tick(), before + 10);
  client->result("scene.load", {{"scene", "mixed"}});
  EXPECT_EQ(client->result("session.join").at("description").at("speed"), 0.5);
}

// Internal failures: unstable scenes, and faults of the server.

class SessionFaults : public SessionTest {};

TEST_F(SessionFaults, AnUnstableSceneIsPausedAtTheLastGoodStateAndReported) {
  client->result("scene.load", {{"scene", "unstable"}});
  const std::string loaded = hash();
  client->result("control.play");
  const Json guard =
      client->wait_event("session.guard", [](const Json& g) { return g.at("recovered") == false; });
  EXPECT_EQ(guard.at("tick"), 0);
  EXPECT_EQ(guard.at("body"), 1);
  EXPECT_EQ(guard.at("cause"), "too_fast");
  EXPECT_TRUE(guard.contains("particle"));
  EXPECT_GT(guard.at("time"), 0);
  client->wait_event("session.status", [](const Json& s) { return s.at("playing") == false; });
  EXPECT_EQ(client->result("session.join").at("description").at("playing"), false);
  EXPECT_EQ(hash(), loaded);
  EXPECT_EQ(tick(), 0u);

  client->result("scene.load", {{"scene", "mixed"}});
  EXPECT_EQ(client->result("control.step", {{"ticks", 3}}).at("tick"), 3) << "the server continues";
}

TEST_F(SessionFaults, AGuardEndsAStep) {
  client->result("scene.load", {{"scene", "unstable"}});
  EXPECT_EQ(client->result("control.step", {{"ticks", 10}}).at("tick"), 0);
  client->wait_event("session.guard");
}

// A connection that throws when sending represents any fault in a turn, such as a lack of memory.
TEST_F(SessionFaults, AFaultPausesTheSessionWhichStillAnswers) {
  const auto other = join();
  client->connection->fail(true);
  other->send("control.play");  // sending its status to this client fails
  client->send("session.hash");
  client->send("session.join");
  client->connection->fail(false);
  for (int i = 0; i < 20; ++i) {
    client->connection->fail(true);
    client->send("session.join");
    client->send("session.hash");
    client->connection->fail(false);
    other->result("session.hash");
  }
  other->result("control.pause");
  const std::uint64_t now = tick();
  EXPECT_EQ(other->result("control.step", {{"ticks", 2}}).at("tick"), now + 2);
  EXPECT_EQ(client->result("control.step", {{"ticks", 2}}).at("tick"), now + 4);
}

TEST_F(SessionFaults, AFaultInOneSessionIsNotOneOfOthers) {
  client->result("session.create", {{"name", "second"}, {"scene", "mixed"}});
  const auto other = join("s2");
  other->result("control.set_speed", {{"speed", 4}});
  other->result("frames.subscribe");
  client->connection->fail(true);
  client->send("session.hash");
  other->wait_frame([](const GridFrame& frame) { return frame.header.tick >= 20; });
  client->connection->fail(false);
  client->result("session.hash");
}

TEST_F(SessionFaults, AreAnsweredToTheIdOfTheirRequest) {
  for (const auto& [method, params] :
       {std::pair<const char*, Json>("server.info", nullptr),
        std::pair<const char*, Json>("session.create", {{"name", "n"}, {"scene", "mixed"}})}) {
    client->connection->fail_next_reply();
    EXPECT_EQ(client->error(method, params).at("code"), -32603) << method;
  }
}

}  // namespace
}  // namespace vat::test::session_control_test
