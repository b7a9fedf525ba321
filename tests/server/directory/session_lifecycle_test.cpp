// Creating, joining, leaving and closing sessions.

#include "tests/server/fixture/session_fixture.h"

namespace vat::test::session_lifecycle_test {
namespace {

using namespace std::chrono_literals;

class SessionLifecycle : public SessionTest {
 protected:
  void SetUp() override { client->result("access.enter", {{"token", kAdminToken}}); }

  std::string create(const std::string& name) { return client->create_session("mixed", name); }
  Json find(const std::string& session) { return client->listed(session); }
};

TEST_F(SessionLifecycle, ANewSessionPlaysAndHasNoClients) {
  EXPECT_EQ(create("second"), "s2");
  const Json entry = find("s2");
  EXPECT_EQ(entry.at("name"), "second");
  EXPECT_EQ(entry.at("scene"), "mixed");
  EXPECT_EQ(entry.at("clients"), 0);
  EXPECT_EQ(entry.at("playing"), true);
  EXPECT_EQ(entry.at("particles"), find("s1").at("particles"));
  EXPECT_EQ(find("s1").at("clients"), 1) << "creating a session does not join it";
}

TEST_F(SessionLifecycle, SessionsOfOneNameAreTwo) {
  EXPECT_EQ(create("twin"), "s2");
  EXPECT_EQ(create("twin"), "s3");
  client->result("session.close", {{"session", "s2"}});
  EXPECT_EQ(find("s3").at("name"), "twin");
  EXPECT_EQ(create("twin"), "s4") << "ids are not reused";
}

TEST_F(SessionLifecycle, WithoutAnIdTheFirstSessionIsJoined) {
  create("second");
  const auto guest = connect();
  EXPECT_EQ(guest->result("session.join").at("session"), "s1");
  client->result("session.close", {{"session", "s1"}});
  EXPECT_EQ(guest->result("session.join").at("session"), "s2");
  client->result("session.close", {{"session", "s2"}});
  EXPECT_EQ(guest->error("session.join").at("data").at("kind"), "no_such_session");
}

TEST_F(SessionLifecycle, AClientIsInOneSessionAtMost) {
  create("second");
  const auto guest = join("s1");
  EXPECT_EQ(find("s1").at("clients"), 2);
  guest->result("session.join", {{"session", "s2"}});
  EXPECT_EQ(find("s1").at("clients"), 1);
  EXPECT_EQ(find("s2").at("clients"), 1);
  guest->result("session.join", {{"session", "s2"}});
  EXPECT_EQ(find("s2").at("clients"), 1) << "a repeated join changes nothing";
  guest->result("session.leave");
  EXPECT_EQ(find("s2").at("clients"), 0);
  EXPECT_EQ(guest->error("session.leave").at("code"), 1001);
}

TEST_F(SessionLifecycle, EveryReplyNamesTheTick) {
  const Json created = client->result("session.create", {{"name", "n"}, {"scene", "mixed"}});
  EXPECT_EQ(created.at("tick"), 0);
  const auto guest = join();
  EXPECT_EQ(guest->result("control.step", {{"ticks", 3}}).at("tick"), 3);
  EXPECT_EQ(guest->result("session.leave").at("tick"), 3);
  client->result("control.step", {{"ticks", 2}});
  guest->result("access.enter", {{"token", kAdminToken}});
  EXPECT_EQ(guest->result("session.close", {{"session", "s1"}}).at("tick"), 5);
}

TEST_F(SessionLifecycle, EveryHashNamesTheInstructionSetOfTheServer) {
  ServerSettings settings;
  settings.threads = 1;
  settings.instructions = InstructionSet::baseline;
  TestServer plain(catalogue, settings);
  ASSERT_TRUE(plain.create_session("plain", to_scene(mixed_scene_text())));
  TestClient guest(plain, 1);
  EXPECT_EQ(guest.result("server.info").at("instruction_set"), "baseline");
  guest.result("session.join");
  EXPECT_EQ(guest.result("session.hash").at("instruction_set"), "baseline");
  guest.result("scene.load", {{"scene", "mixed"}});
  EXPECT_EQ(guest.result("session.hash").at("instruction_set"), "baseline");
  EXPECT_EQ(client->result("session.hash").at("instruction_set"),
            to_string(best_instruction_set()));
}

bool is_draining(const Json& text) {
  return text.value("method", "") == "server.draining";
}

TEST_F(SessionLifecycle, ADrainEndsWhenTheLastClientHasGone) {
  const auto other = connect();
  const auto drain = std::async(std::launch::async, [this] { server.drain(1h); });
  const Json told = client->connection->wait_text(is_draining);
  EXPECT_EQ(told.at("params").at("seconds"), 3600);
  EXPECT_EQ(connect()->connection->close_code(), 1013);
  const Json params{{"name", "n"}, {"scene", "mixed"}};
  EXPECT_EQ(client->error("session.create", params).at("code"), 1006);
  other->disconnect();
  EXPECT_EQ(drain.wait_for(0s), std::future_status::timeout);
  client->disconnect();
  drain.wait();
}

TEST_F(SessionLifecycle, ADrainEndsInTime) {
  const auto drain = std::async(std::launch::async, [this] { server.drain(10s); });
  client->connection->wait_text(is_draining);
  server.clock().advance(9s);
  EXPECT_EQ(drain.wait_for(0s), std::future_status::timeout);
  server.clock().advance(1s);
  drain.wait();
}

// Each pending timer keeps a thread pool running until it expires.
TEST_F(SessionLifecycle, StoppingCancelsAllTimers) {
  client->result("control.play");
  EXPECT_GT(server.clock().waiting(), 0U);
  server.stop();
  EXPECT_EQ(server.clock().waiting(), 0U);
}

TEST_F(SessionLifecycle, TheReplyToACloseFollowsThoseToEarlierCommands) {
  const int step = client->send("control.step", {{"ticks", 1000}});
  const int query = client->send("session.hash");
  const int close = client->send("session.close", {{"session", "s1"}});
  EXPECT_GE(client->wait_reply(close).at("result").at("tick"), 0);
  std::vector<Json> ids;
  for (const Json& text : client->connection->texts()) {
    if (text.contains("id")) ids.push_back(text.at("id"));
  }
  ASSERT_GE(ids.size(), 3u);
  EXPECT_EQ(std::vector<Json>(ids.end() - 3, ids.end()), (std::vector<Json>{step, query, close}));
}

TEST_F(SessionLifecycle, ClosingNotifiesAllParticipants) {
  create("second");
  const auto first = join("s2");
  const auto second = join("s2");
  client->result("session.close", {{"session", "s2"}});
  for (const auto* guest : {&first, &second}) {
    const Json event = (*guest)->wait_event("session.closed");
    EXPECT_EQ(event.at("session"), "s2");
    EXPECT_FALSE(event.at("reason").get<std::string>().empty());
    EXPECT_EQ((*guest)->error("control.play").at("code"), 1001);
  }
  EXPECT_TRUE(client->events("session.closed").empty()) << "the client is in another session";
  EXPECT_EQ(find("s2"), nullptr);
  first->result("session.join", {{"session", "s1"}});
}

TEST_F(SessionLifecycle, ClosingAnswersRequestsThatWaitForAStep) {
  const auto guest = join();
  // The close arrives before the end of these ticks.
  const int step = guest->send("control.step", {{"ticks", 1000}});
  const int query = guest->send("session.hash");
  client->result("session.close", {{"session", "s1"}});
  EXPECT_EQ(guest->wait_reply(step).at("error").at("code"), 1002);
  EXPECT_EQ(guest->wait_reply(query).at("error").at("code"), 1002);
}

TEST_F(SessionLifecycle, AClientThatLeavesGetsNothingMoreOfTheSession) {
  const auto guest = join();
  guest->result("frames.subscribe");
  guest->wait_frame([](const GridFrame&) { return true; });
  guest->result("session.leave");
  const std::size_t texts = guest->connection->texts().size();
  const std::size_t frames = guest->connection->frames().size();
  client->result("world.set_gravity", {{"gravity", {0, 0, 0}}});
  client->result("control.step", {{"ticks", 3}});
  client->wait_event("session.description");
  EXPECT_EQ(guest->connection->texts().size(), texts);
  EXPECT_EQ(guest->connection->frames().size(), frames);
}

TEST_F(SessionLifecycle, ASceneIsLoadedForAll) {
  const auto guest = join();
  guest->mark();
  client->result("control.step", {{"ticks", 3}});
  const Json reply = client->result("scene.load", {{"scene", "unstable"}});
  EXPECT_EQ(reply.at("tick"), 0);
  const Json description = guest->wait_event("session.description");
  EXPECT_EQ(description.at("scene"), "unstable");
  EXPECT_EQ(description.at("tick"), 0);
  EXPECT_EQ(description.at("vat"), nullptr);
  EXPECT_EQ(description.at("playing"), false) << "loading a scene does not start it";
  EXPECT_EQ(find("s1").at("scene"), "unstable");
}

TEST_F(SessionLifecycle, ASceneThatIsRefusedLeavesTheOldOneRunning) {
  client->result("control.set_speed", {{"speed", 4}});
  client->result("frames.subscribe");
  client->result("control.play");
  client->wait_frame([](const GridFrame& frame) { return frame.header.tick >= 3; });
  client->mark();
  Json scene = Json::parse(mixed_scene_text());
  scene["bodies"][2]["material"] = "lead";
  EXPECT_EQ(client->error("scene.load", {{"scene", scene}}).at("data").at("path"),
            "/scene/bodies/2/material");
  const std::uint64_t now = tick();
  client->wait_frame([&](const GridFrame& frame) { return frame.header.tick > now; });
  EXPECT_TRUE(client->events("session.description").empty());
  const std::uint64_t end = client->result("control.pause").at("tick");
  EXPECT_EQ(hash(), mixed_hash_after(end));
}

TEST_F(SessionLifecycle, StoppingNotifiesAllClientsAndEndsAllEffects) {
  const auto outsider = connect();
  const int step = client->send("control.step", {{"ticks", 1000}});
  server.stop();
  EXPECT_EQ(client->wait_event("session.closed").at("reason"), "the server stops");
  EXPECT_EQ(client->wait_reply(step).at("error").at("code"), 1002);
  EXPECT_EQ(outsider->error("session.create", {{"name", "n"}, {"scene", "mixed"}}).at("code"),
            1006);
  EXPECT_EQ(outsider->error("session.join").at("code"), 1002);
  EXPECT_FALSE(server.create_session("n", to_scene(mixed_scene_text())));
  EXPECT_EQ(connect()->connection->close_code(), 1013);
  server.stop();  // again
}

TEST_F(SessionLifecycle, TheServersOwnSessionNamesTheErrorsOfItsScene) {
  Scene scene = to_scene(mixed_scene_text());
  scene.bodies[1].material = "lead";
  const Result<SessionId> session = server.create_session("n", scene);
  ASSERT_FALSE(session);
  EXPECT_EQ(session.errors().front().path, "/scene/bodies/1/material");
}

}  // namespace
}  // namespace vat::test::session_lifecycle_test
