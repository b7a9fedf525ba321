// Commands take effect at the tick that their reply names and in the order in which they were sent:
// the session ends in the bits of a simulation that is given the same commands at these ticks.

#include "tests/server/session_fixture.h"

namespace vat::test::session_command_test {
namespace {

class SessionCommands : public SessionTest {
 protected:
  Simulation reference = Simulation::create(to_scene(mixed_scene_text())).value();

  std::uint64_t tick_of(const std::string& method, const Json& params = nullptr) {
    return client->result(method, params).at("tick");
  }
};

TEST_F(SessionCommands, AFreshSessionHasTheBitsOfTheScene) {
  EXPECT_EQ(hash(), hash_of(reference));
  EXPECT_EQ(tick_of("control.step", {{"ticks", 7}}), 7u);
  advance_ticks(reference, 7);
  EXPECT_EQ(hash(), hash_of(reference));
  EXPECT_EQ(client->result("session.hash").at("time"), reference.time());
}

TEST_F(SessionCommands, OfAPausedSessionTakeEffectBetweenItsSteps) {
  EXPECT_EQ(tick_of("control.step", {{"ticks", 3}}), 3u);
  EXPECT_EQ(tick_of("world.set_gravity", {{"gravity", {1, 0, -5}}}), 3u);
  EXPECT_EQ(tick_of("control.step", {{"ticks", 2}}), 5u);
  EXPECT_EQ(tick_of("world.apply_force", {{"body", 3}, {"force", {20, 0, 0}}, {"duration", 0.05}}),
            5u);
  EXPECT_EQ(tick_of("world.remove_body", {{"body", 2}}), 5u);
  EXPECT_EQ(tick_of("control.step", {{"ticks", 4}}), 9u);

  advance_ticks(reference, 3);
  ASSERT_TRUE(reference.set_gravity(Vec3(1, 0, -5)));
  advance_ticks(reference, 2);
  ASSERT_TRUE(reference.apply_force(3, Vec3(20, 0, 0), 0.05));
  ASSERT_TRUE(reference.remove_body(2));
  advance_ticks(reference, 4);
  EXPECT_EQ(hash(), hash_of(reference));
}

TEST_F(SessionCommands, OfAPlayingSessionTakeEffectAtTheTickOfTheirReply) {
  client->result("control.set_speed", {{"speed", 4}});
  client->result("frames.subscribe");
  client->result("control.play");
  std::vector<std::uint64_t> ticks;
  for (int i = 0; i < 5; ++i) {
    ticks.push_back(tick_of("world.set_gravity", {{"gravity", {i, 0, -9}}}));
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
    ids.push_back(client->send("state.query", {{"bodies", {3}}}));
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

TEST_F(SessionCommands, ManyWaitForALongStepInTheirOrder) {
  const int step = client->send("control.step", {{"ticks", 100}});
  const int gravity = client->send("world.set_gravity", {{"gravity", {0, 0, 0}}});
  const int query = client->send("session.hash");
  EXPECT_EQ(client->wait_reply(step).at("result").at("tick"), 100);
  EXPECT_EQ(client->wait_reply(gravity).at("result").at("tick"), 100);
  advance_ticks(reference, 100);
  EXPECT_EQ(client->wait_reply(query).at("result").at("hash"), [&] {
    EXPECT_TRUE(reference.set_gravity(Vec3::Zero()));
    return hash_of(reference);
  }());
}

TEST_F(SessionCommands, BodiesComeAndGoWithANewEpoch) {
  const Json before = client->result("session.join").at("description");
  const Json body = Json::parse(R"({"name":"second ball","kind":"rigid","material":"wood",
      "spacing":0.1,"shape":{"type":"sphere","radius":0.12},"position":[0.3,0.7,0.7]})");
  const Json added = client->result("world.add_body", {{"body", body}});
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
  client->result("grab.start", {{"body", 2}, {"particle", 0}, {"target", {0.5, 0.5, 0.5}}});
  client->mark();
  EXPECT_EQ(tick_of("world.melt_body", {{"body", 2}, {"material", "water"}}), 3u);
  const Json description = client->wait_event("session.description");
  EXPECT_EQ(description.at("epoch"), before.at("epoch").get<int>() + 1);
  EXPECT_EQ(description.at("bodies").at(1).at("kind"), "liquid");
  EXPECT_EQ(client->error("grab.end", {{"grab", 1}}).at("code"), -32602);
  client->result("control.step", {{"ticks", 3}});
  advance_ticks(reference, 3);
  ASSERT_TRUE(reference.melt_body(2, "water"));
  advance_ticks(reference, 3);
  EXPECT_EQ(hash(), hash_of(reference));
}

// The frame of the tick in which a body melts comes after the description that it belongs to.
TEST_F(SessionCommands, ABodyThatMeltsOnTimeBeginsAnEpoch) {
  Json scene = Json::parse(mixed_scene_text());
  scene["bodies"][1]["melting"] = {{"into", "water"}, {"at", 0.05}};
  client->result("scene.load", {{"scene", scene}});
  const Json before = client->wait_event("session.description");
  client->result("frames.subscribe");
  const Json grab =
      client->result("grab.start", {{"body", 2}, {"particle", 0}, {"target", {0.5, 0.5, 0.5}}});
  client->mark();
  client->result("control.step", {{"ticks", 3}});
  const Json description = client->wait_event("session.description");
  EXPECT_EQ(description.at("epoch"), before.at("epoch").get<int>() + 1);
  EXPECT_EQ(description.at("tick"), 3);
  EXPECT_EQ(description.at("bodies").at(1).at("kind"), "liquid");
  const GridFrame frame =
      client->wait_frame([](const GridFrame& each) { return each.header.tick == 3; });
  EXPECT_EQ(frame.header.epoch, description.at("epoch").get<std::uint32_t>());
  EXPECT_EQ(client->error("grab.end", {{"grab", grab.at("grab")}}).at("code"), -32602);
}

/// The mixed scene with a nozzle that feeds its pool.
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
  // The tube holds two layers of one particle, and others come 0 s and 0.1 s after these; the last
  // step of the ten ticks begins before 0.2 s.
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

TEST_F(SessionCommands, WhatMayFlowInCountsForTheLimits) {
  const Json error = client->error("scene.load", {{"scene", scene_with_nozzle(200'000)}});
  EXPECT_EQ(error.at("code"), 1005);
  EXPECT_EQ(error.at("data").at("limit"), "particles");
}

TEST_F(SessionCommands, GravityAndInterfacesAreOfTheSceneFromThenOn) {
  client->result("world.set_gravity", {{"gravity", {0, 0, -1}}});
  EXPECT_EQ(client->wait_event("session.description").at("gravity"), Json({0, 0, -1}));
  client->result("world.set_interface",
                 {{"interface", {{"materials", {"wood", "vat"}}, {"stiffness", 5000}}}});
  client->result("control.step", {{"ticks", 40}});
  InterfaceDescription interface;
  interface.materials = {"wood", "vat"};
  interface.constants.stiffness = 5000;
  ASSERT_TRUE(reference.set_gravity(Vec3(0, 0, -1)));
  ASSERT_TRUE(reference.set_interface(interface));
  advance_ticks(reference, 40);
  EXPECT_EQ(hash(), hash_of(reference));
}

}  // namespace
}  // namespace vat::test::session_command_test
