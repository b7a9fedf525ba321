// Commands take effect at the tick in their reply, in the order of sending. The session has the
// same bits as a simulation that receives the same commands at these ticks.

#include <gmock/gmock.h>

#include "protocol/scene/scene_json.h"
#include "server/rpc/method_table.h"
#include "server/session/pointer_commands.h"
#include "tests/server/fixture/session_fixture.h"

namespace vat::test::session_command_test {
namespace {

class SessionCommands : public SessionTest {
 protected:
  Simulation reference = mixed_simulation();

  std::uint64_t tick_of(const std::string& method, const Json& params = nullptr) {
    return client->result(method, params).at("tick");
  }
};

/// A command, and the equivalent call of a simulation.
struct Command {
  const char* method;
  Json params;
  std::function<Status(Simulation&)> apply;
};

InterfaceDescription wood_on_vat() {
  InterfaceDescription interface;
  interface.materials = {"wood", "vat"};
  interface.constants.stiffness = 5000;
  return interface;
}

const BodyPlacement kShifted{{0.4, 0.45, 0.25}, {}, {}};
const BodyPlacement kTurned{{0.83, 0.7, 0.6}, Quat(0.6, 0.8, 0, 0), Vec3(2, 0, 0)};

// The ball hits a wall, so its interface with the vat acts.
TEST_F(SessionCommands, OfAPausedSessionTakeEffectBetweenItsSteps) {
  const std::string fresh = hash();
  EXPECT_EQ(fresh, hash_of(reference));
  Json rubber = client->result("scene.get").at("scene").at("materials").at(1);
  rubber["springs"]["structural"]["stiffness"] = 900;
  const std::vector<Command> commands = {
      {"world.set_gravity",
       {{"gravity", {1, 0, -5}}},
       [](Simulation& s) { return s.set_gravity(Vec3(1, 0, -5)); }},
      {"world.apply_force",
       {{"body", 3}, {"force", {20, 0, 0}}, {"duration", 0.05}},
       [](Simulation& s) { return s.apply_force(3, Vec3(20, 0, 0), 0.05); }},
      {"world.move_body",
       {{"body", 3},
        {"position", {0.83, 0.7, 0.6}},
        {"orientation", {0.6, 0.8, 0, 0}},
        {"velocity", {2, 0, 0}}},
       [](Simulation& s) { return s.move_body(3, kTurned); }},
      {"world.set_interface",
       {{"interface", {{"materials", {"wood", "vat"}}, {"stiffness", 5000}}}},
       [](Simulation& s) { return s.set_interface(wood_on_vat()); }},
      {"world.move_body",
       {{"body", 1}, {"position", {0.4, 0.45, 0.25}}},
       [](Simulation& s) { return s.move_body(1, kShifted); }},
      {"world.set_material",
       {{"material", rubber}},
       [&](Simulation& s) { return s.set_material(read_material(rubber, "/material").value()); }},
      {"world.move_vat",
       {{"offset", {0.3, 0, 0}}},
       [](Simulation& s) { return s.move_vat(Vec3(0.3, 0, 0)); }},
      {"world.set_numerics",
       {{"integrator", "runge_kutta_4"}},
       [](Simulation& s) { return s.set_numerics(IntegratorId::runge_kutta_4, 0.002); }},
      {"world.set_numerics",
       {{"integrator", "heun"}, {"step", 0.001}},
       [](Simulation& s) { return s.set_numerics(IntegratorId::heun, 0.001); }},
      {"world.melt_body",
       {{"body", 2}, {"material", "water"}},
       [](Simulation& s) { return s.melt_body(2, "water"); }},
      {"world.remove_body", {{"body", 3}}, [](Simulation& s) { return s.remove_body(3); }},
  };
  constexpr int kTicks = 3;
  std::uint64_t now = 0;
  for (const Command& command : commands) {
    SCOPED_TRACE(std::string(command.method) + command.params.dump());
    EXPECT_EQ(tick_of(command.method, command.params), now);
    EXPECT_EQ(tick_of("control.step", {{"ticks", kTicks}}), now += kTicks);
    ASSERT_TRUE(command.apply(reference).ok());
    advance_ticks(reference, kTicks);
    ASSERT_EQ(hash(), hash_of(reference));
  }
  EXPECT_EQ(client->result("session.hash").at("time"), reference.time());
  const Json numerics = client->result("scene.get", {{"current", true}}).at("scene").at("numerics");
  EXPECT_EQ(numerics.at("integrator"), "heun");
  EXPECT_EQ(numerics.at("step"), 0.001);
  client->result("control.reset");
  EXPECT_EQ(hash(), fresh);
}

TEST_F(SessionCommands, OfAPlayingSessionTakeEffectAtTheTickOfTheirReply) {
  client->result("control.set_speed", {{"speed", 4}});
  client->result("frames.subscribe");
  client->result("control.play");
  std::vector<std::uint64_t> ticks;
  for (int i = 0; i < 5; ++i) {
    const int id = client->send("world.set_gravity", {{"gravity", {i, 0, -9}}});
    ticks.push_back(client->wait_reply_at_tick(id).at("result").at("tick"));
    client->wait_frame(
        [&](const GridFrame& frame) { return frame.header.tick > ticks.back() + 1; });
  }
  const std::uint64_t end = tick_of("control.pause");

  std::uint64_t now = 0;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    ASSERT_GE(ticks[i], now);
    advance_ticks(reference, ticks[i] - now);
    now = ticks[i];
    ASSERT_TRUE(reference.set_gravity(Vec3(static_cast<Real>(i), 0, -9)));
  }
  advance_ticks(reference, end - now);
  EXPECT_EQ(hash(), hash_of(reference));
  EXPECT_EQ(tick(), end);
  EXPECT_GT(end, 0u);
}

TEST_F(SessionCommands, AreAnsweredInTheirOrder) {
  std::vector<int> ids;
  for (int i = 0; i < 50; ++i) {
    ids.push_back(client->send("world.set_gravity", {{"gravity", {0, 0, -i}}}));
    ids.push_back(client->send("control.step"));
    ids.push_back(client->send("session.stats"));
  }
  client->wait_reply(ids.back());
  std::vector<int> answered;
  for (const Json& text : client->connection->texts()) {
    if (text.contains("result") && text.at("id") >= ids.front()) answered.push_back(text.at("id"));
  }
  EXPECT_EQ(answered, ids);
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(reference.set_gravity(Vec3(0, 0, -i)));
    advance_ticks(reference, 1);
    const Json reply = client->wait_reply(ids[3 * static_cast<std::size_t>(i) + 2]);
    EXPECT_EQ(reply.at("result").at("tick"), i + 1);
  }
  EXPECT_EQ(hash(), hash_of(reference));
}

// A read may be answered after later commands. It describes a state after all earlier ones.
TEST_F(SessionCommands, ReadsFollowTheEarlierCommandsOfTheirClient) {
  std::vector<int> reads;
  for (int i = 0; i < 50; ++i) {
    client->send("control.step");
    reads.push_back(client->send("state.query", {{"bodies", {3}}}));
  }
  std::uint64_t last = 0;
  for (std::size_t i = 0; i < reads.size(); ++i) {
    const std::uint64_t of_read = client->wait_reply(reads[i]).at("result").at("tick");
    EXPECT_GE(of_read, i + 1);
    EXPECT_GE(of_read, last);
    last = of_read;
  }
  EXPECT_EQ(last, 50U);
}

TEST_F(SessionCommands, BodiesComeAndGoWithANewEpoch) {
  const Json before = client->result("session.join").at("description");
  const Json added = client->result("world.add_body", {{"body", wooden_ball("second ball")}});
  EXPECT_EQ(added.at("body"), 4);
  Json description = client->wait_event("session.description");
  EXPECT_EQ(description.at("epoch"), before.at("epoch").get<int>() + 1);
  EXPECT_EQ(description.at("bodies").size(), 4u);
  EXPECT_EQ(description.at("bodies").at(3).at("name"), "second ball");
  client->mark();
  client->result("world.remove_body", {{"body", 4}});
  description = client->wait_event("session.description");
  EXPECT_EQ(description.at("epoch"), before.at("epoch").get<int>() + 2);
  EXPECT_EQ(description.at("bodies"), before.at("bodies"));
}

TEST_F(SessionCommands, ABodyMeltsWithANewEpoch) {
  const Json before = client->result("session.join").at("description");
  client->result("control.step", {{"ticks", 3}});
  const std::uint64_t grab = client->grab(2);
  client->mark();
  EXPECT_EQ(tick_of("world.melt_body", {{"body", 2}, {"material", "water"}}), 3u);
  const Json description = client->wait_event("session.description");
  EXPECT_EQ(description.at("epoch"), before.at("epoch").get<int>() + 1);
  EXPECT_EQ(description.at("bodies").at(1).at("kind"), "liquid");
  EXPECT_EQ(client->error("grab.end", {{"grab", grab}}).at("code"), -32602);
}

// The frame of the tick in which a body melts follows the description with the new epoch.
TEST_F(SessionCommands, ABodyThatMeltsOnTimeBeginsAnEpoch) {
  Json scene = Json::parse(mixed_scene_text());
  scene["bodies"][1]["melting"] = {{"into", "water"}, {"at", 0.05}};
  client->result("scene.load", {{"scene", scene}});
  const Json before = client->wait_event("session.description");
  client->result("frames.subscribe");
  const std::uint64_t grab = client->grab(2);
  client->mark();
  client->result("control.step", {{"ticks", 3}});
  const Json description = client->wait_event("session.description");
  EXPECT_EQ(description.at("epoch"), before.at("epoch").get<int>() + 1);
  EXPECT_EQ(description.at("tick"), 3);
  EXPECT_EQ(description.at("bodies").at(1).at("kind"), "liquid");
  const GridFrame frame =
      client->wait_frame([](const GridFrame& each) { return each.header.tick == 3; });
  EXPECT_EQ(frame.header.epoch, description.at("epoch").get<std::uint32_t>());
  EXPECT_EQ(client->error("grab.end", {{"grab", grab}}).at("code"), -32602);
}

/// The mixed scene with a nozzle that emits into the pool.
Json scene_with_nozzle(std::size_t most_particles) {
  Json scene = Json::parse(mixed_scene_text());
  scene["emitters"] = {{{"name", "tap"},
                        {"body", "pool"},
                        {"position", {0.3, 0.1, 0.9}},
                        {"direction", {1, 0, 0}},
                        {"size", {0.1, 0.1}},
                        {"speed", 1},
                        {"most_particles", most_particles}}};
  return scene;
}

TEST_F(SessionCommands, LiquidFlowsInWithoutANewEpoch) {
  client->result("scene.load", {{"scene", scene_with_nozzle(1000)}});
  const Json before = client->wait_event("session.description");
  client->result("frames.subscribe");
  client->mark();
  client->result("control.step", {{"ticks", 10}});
  const GridFrame frame =
      client->wait_frame([](const GridFrame& each) { return each.header.tick == 10; });
  EXPECT_EQ(frame.header.epoch, before.at("epoch").get<std::uint32_t>());
  const auto particles = before.at("bodies").at(0).at("particles").get<std::size_t>();
  // The tube contains two layers of one particle. Two more follow after 0 s and 0.1 s. The last
  // step of the ten ticks starts before 0.2 s.
  EXPECT_EQ(frame.blocks.at(1).positions.size(), 3 * (particles + 4));
  EXPECT_TRUE(client->events("session.description").empty());
  const Json state = client->result("state.query", {{"bodies", {"pool"}}});
  EXPECT_EQ(state.at("bodies").at(0).at("positions").size(), particles + 4);
}

TEST_F(SessionCommands, AnEmitterCloses) {
  const Json scene = scene_with_nozzle(1000);
  client->result("scene.load", {{"scene", scene}});
  client->result("world.set_emitter", {{"emitter", "tap"}, {"open", false}});
  client->result("control.step", {{"ticks", 10}});
  Simulation closed = std::move(Simulation::create(to_scene(scene.dump()))).value();
  ASSERT_TRUE(closed.set_emitter("tap", false));
  advance_ticks(closed, 10);
  EXPECT_EQ(hash(), hash_of(closed));
}

TEST_F(SessionCommands, FutureInflowCountsForTheLimits) {
  const Json error = client->error("scene.load", {{"scene", scene_with_nozzle(200'000)}});
  EXPECT_EQ(error.at("code"), 1005);
  EXPECT_EQ(error.at("data").at("limit"), "particles");
}

const MethodRow* row_of(std::string_view method) {
  return session_methods().find(method);
}

class PointerCommandsTest : public testing::Test {
 protected:
  void add(ParticipantNumber participant, std::string_view method, const Json& params) {
    pointers.add(participant, {row_of(method), params, {}}, PendingReply(outbox, {}));
  }
  /// Returns "PARTICIPANT PARAMS CALLERS" of each waiting command.
  std::vector<std::string> take() {
    std::vector<std::string> taken;
    for (const auto& newest : pointers.take()) {
      taken.push_back(std::to_string(newest.participant) + " " + newest.command.params.dump() +
                      " " + std::to_string(newest.replies.size()));
    }
    return taken;
  }
  const std::shared_ptr<ClientOutbox> outbox =
      std::make_shared<ClientOutbox>(std::make_shared<FakeConnection>(1));
  PointerCommands pointers;
};

TEST_F(PointerCommandsTest, TheNewestOfOneParticipantAboutOneThingCountsForAll) {
  add(1, "grab.move", {{"grab", 5}, {"to", 1}});
  add(1, "grab.move", {{"grab", 6}, {"to", 2}});
  add(2, "grab.move", {{"grab", 5}, {"to", 3}});
  add(1, "grab.move", {{"grab", 5}, {"to", 4}});
  add(1, "grab.move", {{"grab", 5}, {"to", 5}});
  EXPECT_THAT(take(), testing::ElementsAre(R"(1 {"grab":6,"to":2} 1)", R"(2 {"grab":5,"to":3} 1)",
                                           R"(1 {"grab":5,"to":5} 3)"));
  EXPECT_TRUE(pointers.empty());
}

TEST_F(PointerCommandsTest, EachBodyAndTheVatAreThingsOfTheirOwn) {
  for (const int to : {1, 2}) {
    add(1, "world.move_vat", {{"to", to}});
    for (const int body : {2, 3}) add(1, "world.move_body", {{"body", body}, {"to", to}});
  }
  EXPECT_THAT(take(), testing::ElementsAre(R"(1 {"to":2} 2)", R"(1 {"body":2,"to":2} 2)",
                                           R"(1 {"body":3,"to":2} 2)"));
}

TEST_F(PointerCommandsTest, TheLastCommandIsExecutedLast) {
  add(1, "world.set_gravity", {{"to", 1}});
  add(2, "world.set_gravity", {{"to", 2}});
  add(1, "world.set_gravity", {{"to", 3}});
  EXPECT_THAT(take(), testing::ElementsAre(R"(2 {"to":2} 1)", R"(1 {"to":3} 2)"));
}

TEST_F(PointerCommandsTest, ReportsWaitingClients) {
  add(2, "world.set_gravity", {{"to", 1}});
  EXPECT_TRUE(pointers.has_of(2));
  EXPECT_FALSE(pointers.has_of(1));
}

// At a speed of 1/20 a tick takes 0.4 s. All commands arrive between two ticks.
TEST_F(SessionTest, CommandsThatFollowAPointerWaitForTheNextTickAndAreAnsweredWithIt) {
  client->result("control.set_speed", {{"speed", 0.05}});
  client->result("control.play");
  client->result("frames.subscribe");
  const std::uint64_t before =
      client->wait_frame([](const GridFrame& frame) { return frame.header.tick > 0; }).header.tick;
  std::vector<int> ids;
  for (int i = 1; i <= 5; ++i) {
    ids.push_back(client->send("world.set_gravity", {{"gravity", {0, 0, -i}}}));
  }
  std::vector<std::uint64_t> ticks;
  for (const int id : ids) ticks.push_back(client->wait_reply_at_tick(id).at("result").at("tick"));
  EXPECT_THAT(ticks, testing::Each(ticks.front()));
  EXPECT_EQ(ticks.front(), before);
  const Json description = client->wait_event("session.description", [](const Json& d) {
    return d.at("gravity") != Json({0, 0, -9.81});
  });
  EXPECT_EQ(description.at("gravity"), Json({0, 0, -5})) << "an earlier command was executed";
}

TEST_F(SessionTest, AReadIsAnsweredAfterEarlierCommandsOfItsClient) {
  client->result("control.set_speed", {{"speed", 0.05}});
  client->result("control.play");
  const std::string before = hash();
  const int gravity = client->send("world.set_gravity", {{"gravity", {0, 0, -1}}});
  const Json answer = client->result("session.hash");
  EXPECT_NE(answer.at("hash"), before);
  EXPECT_EQ(client->wait_reply(gravity).at("result").at("tick"), answer.at("tick"));
}

}  // namespace
}  // namespace vat::test::session_command_test
