// Sessions come, are joined, left and closed.

#include "tests/server/session_fixture.h"

namespace vat::test::session_lifecycle_test {
namespace {

class SessionLifecycle : public SessionTest {
 protected:
  using SessionTest::SessionTest;
  void SetUp() override { client->result("access.enter", {{"token", kAdminToken}}); }

  std::string create(const std::string& name, const Json& scene = "mixed") {
    return client->result("session.create", {{"name", name}, {"scene", scene}}).at("session");
  }
  /// The entry of session.list, or null.
  Json find(const std::string& session) {
    const Json list = client->result("session.list");
    for (const Json& entry : list.at("sessions")) {
      if (entry.at("session") == session) return entry;
    }
    return nullptr;
  }
};

TEST_F(SessionLifecycle, ANewSessionPlaysAndHasNoClients) {
  EXPECT_EQ(create("second"), "s2");
  const Json entry = find("s2");
  EXPECT_EQ(entry.at("name"), "second");
  EXPECT_EQ(entry.at("scene"), "mixed");
  EXPECT_EQ(entry.at("clients"), 0);
  EXPECT_EQ(entry.at("playing"), true);
  EXPECT_EQ(entry.at("particles"), find("s1").at("particles"));
  EXPECT_EQ(find("s1").at("clients"), 1) << "to create is not to join";
}

TEST_F(SessionLifecycle, SessionsOfOneNameAreTwo) {
  EXPECT_EQ(create("twin"), "s2");
  EXPECT_EQ(create("twin"), "s3");
  client->result("session.close", {{"session", "s2"}});
  EXPECT_EQ(find("s3").at("name"), "twin");
  EXPECT_EQ(create("twin"), "s4") << "an id is never used twice";
}

TEST_F(SessionLifecycle, ASceneCanBeWritten) {
  const std::string id = create("written", Json::parse(mixed_scene_text()));
  const auto guest = join(id);
  guest->result("control.pause");
  guest->result("control.reset");
  EXPECT_EQ(guest->result("session.hash").at("hash"), hash());
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
  EXPECT_EQ(find("s2").at("clients"), 1) << "to join again is to stay";
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
  SessionServer plain(catalogue, settings);
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

TEST_F(SessionLifecycle, WhoClosesASessionIsAnsweredAfterItsEarlierCommands) {
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

TEST_F(SessionLifecycle, ASessionLivesOnWithoutClients) {
  client->result("world.set_gravity", {{"gravity", {0, 0, 0}}});
  client->result("control.step", {{"ticks", 5}});
  const std::string before = hash();
  client->result("session.leave");
  EXPECT_EQ(find("s1").at("clients"), 0);
  client->result("session.join", {{"session", "s1"}});
  EXPECT_EQ(hash(), before);

  client->result("control.play");
  client->disconnect();
  client = join();
  EXPECT_EQ(find("s1").at("playing"), true);
}

TEST_F(SessionLifecycle, ClosingTellsAllWhoAreInIt) {
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
  EXPECT_TRUE(client->events("session.closed").empty()) << "it is in another session";
  EXPECT_EQ(find("s2"), nullptr);
  first->result("session.join", {{"session", "s1"}});
}

TEST_F(SessionLifecycle, ClosingEndsTheEventsAndTheFramesOfTheSession) {
  create("second");
  const auto guest = join("s2");
  guest->result("frames.subscribe");
  guest->wait_frame([](const GridFrame&) { return true; });
  client->result("session.close", {{"session", "s2"}});
  guest->wait_event("session.closed");
  const std::vector<Json> texts = guest->connection->texts();
  EXPECT_EQ(texts.back().at("method"), "session.closed");
  guest->result("server.info");
  EXPECT_EQ(guest->connection->texts().size(), texts.size() + 1);
}

TEST_F(SessionLifecycle, ClosingAnswersWhatWaitsForAStep) {
  const auto guest = join();
  // So many ticks that the close comes before their end.
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
  EXPECT_EQ(description.at("playing"), false) << "to load is not to play";
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
  Simulation reference = Simulation::create(to_scene(mixed_scene_text())).value();
  advance_ticks(reference, end);
  EXPECT_EQ(hash(), hash_of(reference));
}

TEST_F(SessionLifecycle, StoppingTellsAllClientsAndEndsAllEffects) {
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

ServerLimits small_limits() {
  ServerLimits limits;
  limits.max_connections = 4;
  limits.max_sessions = 2;
  limits.max_clients_per_session = 2;
  limits.max_particles = 150;
  limits.max_particle_steps_per_tick = 1500;
  limits.max_grabs_per_client = 2;
  limits.max_commands_in_flight = 4;
  return limits;
}

class SmallServer : public SessionLifecycle {
 protected:
  SmallServer() : SessionLifecycle(small_limits()) {}

  void expect_limit(const Json& error, const std::string& limit, std::size_t maximum) {
    EXPECT_EQ(error.at("code"), 1005) << error;
    EXPECT_EQ(error.at("data").at("kind"), "limit_reached");
    EXPECT_EQ(error.at("data").at("limit"), limit);
    EXPECT_EQ(error.at("data").at("maximum"), maximum);
  }
};

TEST_F(SmallServer, HasAtMostSoManyConnections) {
  std::vector<std::unique_ptr<TestClient>> clients;
  for (int i = 0; i < 3; ++i) clients.push_back(connect());
  const auto refused = connect();
  EXPECT_EQ(refused->connection->close_code(), 1013);
  clients.back()->disconnect();
  EXPECT_FALSE(connect()->connection->close_code().has_value()) << "there is room again";
}

TEST_F(SmallServer, HasAtMostSoManySessions) {
  create("second");
  const Json params = {{"name", "third"}, {"scene", "mixed"}};
  expect_limit(client->error("session.create", params), "sessions", 2);
  client->result("session.close", {{"session", "s2"}});
  EXPECT_EQ(create("third"), "s3");
}

TEST_F(SmallServer, HasAtMostSoManySessionsHoweverManyAreCreatedAtOnce) {
  std::vector<int> ids;
  for (int i = 0; i < 4; ++i) {
    ids.push_back(client->send("session.create", {{"name", "n"}, {"scene", "mixed"}}));
  }
  int created = 0;
  for (const int id : ids) created += client->wait_reply(id).contains("result") ? 1 : 0;
  EXPECT_EQ(created, 1);
  EXPECT_EQ(client->result("session.list").at("sessions").size(), 2u);
}

TEST_F(SmallServer, HasAtMostSoManyClientsInASession) {
  const auto second = join();
  const auto third = connect();
  expect_limit(third->error("session.join"), "clients_per_session", 2);
  EXPECT_EQ(third->error("session.hash").at("code"), 1001);
  second->result("session.join");  // it is in already
  second->disconnect();
  third->result("session.join");
}

TEST_F(SmallServer, HasAtMostSoManyParticlesInASession) {
  const std::string before = hash();
  Json scene = Json::parse(mixed_scene_text());
  scene["bodies"][0]["spacing"] = 0.05;
  expect_limit(client->error("scene.load", {{"scene", scene}}), "particles", 150);
  expect_limit(client->error("session.create", {{"name", "n"}, {"scene", scene}}), "particles",
               150);
  Json body = scene["bodies"][1];
  body["name"] = "more";
  body["spacing"] = 0.03;
  expect_limit(client->error("world.add_body", {{"body", body}}), "particles", 150);
  EXPECT_EQ(hash(), before);
  EXPECT_EQ(client->result("session.join").at("description").at("epoch"), 2);
  client->result("control.step", {{"ticks", 3}});
}

TEST_F(SmallServer, HasAtMostSoMuchWorkInATick) {
  Json scene = Json::parse(mixed_scene_text());
  scene["numerics"]["step"] = 0.001;
  expect_limit(client->error("scene.load", {{"scene", scene}}), "particle_steps_per_tick", 1500);
}

TEST_F(SmallServer, HasAtMostSoManyCommandsOfAClientInFlight) {
  std::vector<int> ids{client->send("control.step", {{"ticks", 1000}})};
  for (int i = 0; i < 4; ++i) ids.push_back(client->send("session.hash"));
  expect_limit(client->wait_reply(ids.back()).at("error"), "commands_in_flight", 4);
  const auto other = join();
  other->result("control.pause");  // ends the step, and is not counted for the first client
  for (std::size_t i = 0; i + 1 < ids.size(); ++i) {
    EXPECT_TRUE(client->wait_reply(ids[i]).contains("result"));
  }
  client->result("session.hash");
}

}  // namespace
}  // namespace vat::test::session_lifecycle_test
