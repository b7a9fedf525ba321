// What goes wrong inside: unstable scenes, and faults of the server itself.

#include "tests/server/session_fixture.h"

namespace vat::test::session_fault_test {
namespace {

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
  EXPECT_EQ(client->result("control.step", {{"ticks", 3}}).at("tick"), 3) << "the server lives";
}

TEST_F(SessionFaults, AGuardEndsAStep) {
  client->result("scene.load", {{"scene", "unstable"}});
  EXPECT_EQ(client->result("control.step", {{"ticks", 10}}).at("tick"), 0);
  client->wait_event("session.guard");
}

// A connection whose sends throw stands for any fault in a turn: memory that runs out, say.
TEST_F(SessionFaults, AFaultPausesTheSessionWhichGoesOnListening) {
  const auto other = join();
  client->connection->fail(true);
  other->send("control.play");  // its status cannot be sent to all
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

TEST_F(SessionFaults, AFaultWhileAMessageIsReadIsAnsweredToItsId) {
  client->connection->fail_next_reply();
  const int id = client->send("server.info");
  EXPECT_EQ(client->wait_reply(id).at("error").at("code"), -32603);
}

TEST_F(SessionFaults, AFaultWhileASessionIsCreatedIsAnsweredToItsId) {
  client->connection->fail_next_reply();
  const int id = client->send("session.create", {{"name", "n"}, {"scene", "mixed"}});
  EXPECT_EQ(client->wait_reply(id).at("error").at("code"), -32603);
}

}  // namespace
}  // namespace vat::test::session_fault_test
