// What an editor does to a session: bodies put elsewhere, materials, the vat moved by hand. And
// what it is shown of springs, contacts and energies.

#include <optional>

#include "protocol/scene_json.h"
#include "server/storage/database.h"
#include "tests/server/host.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::session_edit_test {
namespace {

class SessionEdits : public SessionTest {
 protected:
  Simulation reference = Simulation::create(to_scene(mixed_scene_text())).value();

  Json material(std::size_t index) {
    return client->result("scene.get").at("scene").at("materials").at(index);
  }
  void step(int ticks) { client->result("control.step", {{"ticks", ticks}}); }
};

TEST_F(SessionEdits, HaveTheBitsOfASimulationThatIsGivenTheSame) {
  step(3);
  client->result("world.move_body", {{"body", 3},
                                     {"position", {0.3, 0.7, 0.8}},
                                     {"orientation", {0.6, 0.8, 0, 0}},
                                     {"velocity", {1, 0, 0}}});
  client->result("world.move_body", {{"body", 1}, {"position", {0.4, 0.45, 0.25}}});
  step(2);
  Json rubber = material(1);
  rubber["springs"]["structural"]["stiffness"] = 900;
  client->result("world.set_material", {{"material", rubber}});
  client->result("world.move_vat", {{"offset", {0.3, 0, 0}}});
  step(5);

  advance_ticks(reference, 3);
  ASSERT_TRUE(reference.move_body(3, {{0.3, 0.7, 0.8}, Quat(0.6, 0.8, 0, 0), Vec3(1, 0, 0)}).ok());
  ASSERT_TRUE(reference.move_body(1, {{0.4, 0.45, 0.25}, {}, {}}).ok());
  advance_ticks(reference, 2);
  ASSERT_TRUE(reference.set_material(read_material(rubber, "/material").value()).ok());
  ASSERT_TRUE(reference.move_vat({0.3, 0, 0}).ok());
  advance_ticks(reference, 5);
  EXPECT_EQ(hash(), hash_of(reference));
  client->result("control.reset");
  EXPECT_EQ(hash(), hash_of(Simulation::create(to_scene(mixed_scene_text())).value()));
}

TEST_F(SessionEdits, BringBackABodyAsItWas) {
  step(20);
  for (const char* name : {"pool", "cube", "ball"}) {
    const Json state = client->result("state.query", {{"bodies", {name}}}).at("bodies").at(0);
    const Json scene = client->result("scene.get", {{"current", true}}).at("scene");
    Json body;
    for (const Json& one : scene.at("bodies")) {
      if (one.at("name") == name) body = one;
    }
    const bool is_rigid = state.contains("orientation");
    Json motion;
    for (const char* member : {"positions", "velocities"}) {
      if (!is_rigid) motion[member] = state.at(member);
    }
    for (const char* member : {"center_of_mass", "orientation", "velocity", "angular_velocity"}) {
      if (is_rigid) motion[member] = state.at(member);
    }
    client->result("world.remove_body", {{"body", state.at("body")}});
    const Json id =
        client->result("world.add_body", {{"body", body}, {"state", motion}}).at("body");
    const Json back = client->result("state.query", {{"bodies", {name}}}).at("bodies").at(0);
    EXPECT_EQ(back.at("body"), id);
    if (!is_rigid) {
      EXPECT_EQ(back.at("positions"), state.at("positions"));
      EXPECT_EQ(back.at("velocities"), state.at("velocities"));
    } else {
      EXPECT_EQ(back.at("center_of_mass"), state.at("center_of_mass"));
    }
    const std::string before = hash();
    const auto path = [&](const Json& wrong) {
      Json other = body;
      other["name"] = "other";
      const Json error = client->error("world.add_body", {{"body", other}, {"state", wrong}});
      EXPECT_EQ(hash(), before);
      return error.at("data").at("path").get<std::string>();
    };
    Json wrong = motion;
    wrong["colour"] = "red";
    EXPECT_EQ(path(wrong), "/state/colour");
    wrong = motion;
    wrong.erase(is_rigid ? "velocity" : "velocities");
    EXPECT_EQ(path(wrong), is_rigid ? "/state/velocity" : "/state/velocities");
    wrong = motion;
    (is_rigid ? wrong["center_of_mass"][2] : wrong["positions"][0][2]) = 50;
    EXPECT_EQ(path(wrong), "/state");
    EXPECT_EQ(path(Json::array()), "/state");
  }
}

TEST_F(SessionEdits, OfNumericsAreThoseOfTheSimulation) {
  step(3);
  client->result("world.set_numerics", {{"integrator", "runge_kutta_4"}});
  step(2);
  client->result("world.set_numerics", {{"step", 0.005}});
  step(2);
  client->result("world.set_numerics", {{"integrator", "heun"}, {"step", 0.001}});
  step(2);
  advance_ticks(reference, 3);
  ASSERT_TRUE(reference.set_numerics(IntegratorId::runge_kutta_4, 0.002).ok());
  advance_ticks(reference, 2);
  ASSERT_TRUE(reference.set_numerics(IntegratorId::runge_kutta_4, 0.005).ok());
  advance_ticks(reference, 2);
  ASSERT_TRUE(reference.set_numerics(IntegratorId::heun, 0.001).ok());
  advance_ticks(reference, 2);
  EXPECT_EQ(hash(), hash_of(reference));
  const Json scene = client->result("scene.get", {{"current", true}}).at("scene");
  EXPECT_EQ(scene.at("numerics").at("integrator"), "heun");
  EXPECT_EQ(scene.at("numerics").at("step"), 0.001);
  const std::string before = hash();
  const auto path = [&](const Json& params) {
    const Json error = client->error("world.set_numerics", params);
    EXPECT_EQ(hash(), before);
    return error.at("data").at("path").get<std::string>();
  };
  EXPECT_EQ(path({{"integrator", "leapfrog"}}), "/integrator");
  EXPECT_EQ(path({{"step", 0.003}}), "/step");
  EXPECT_EQ(path({{"step", 1}}), "/step");
  EXPECT_EQ(path({{"step", 0.001}, {"tick", 0.01}}), "/tick");
  EXPECT_EQ(path(Json::object()), "/integrator");
  client->result("control.reset");
  EXPECT_EQ(hash(), hash_of(Simulation::create(to_scene(mixed_scene_text())).value()));
}

TEST_F(SessionEdits, AreRefusedByTheirPlaceAndChangeNothing) {
  const std::string before = hash();
  const auto path = [&](const char* method, const Json& params) {
    const Json error = client->error(method, params);
    EXPECT_EQ(hash(), before);
    return error.at("data").at("path").get<std::string>();
  };
  EXPECT_EQ(path("world.move_body", {{"body", 9}, {"position", {0, 0, 0}}}), "/body");
  EXPECT_EQ(path("world.move_body", {{"body", 3}, {"position", {0, 0, 0}}}), "/position");
  EXPECT_EQ(path("world.move_body", {{"body", 3}}), "/position");
  const Json place = {0.5, 0.5, 0.7};
  EXPECT_EQ(path("world.move_body", {{"body", 3}, {"position", place}, {"orientation", {1, 0}}}),
            "/orientation");
  EXPECT_EQ(
      path("world.move_body", {{"body", 3}, {"position", place}, {"orientation", {1, 0, 0, 3}}}),
      "/orientation/3");
  EXPECT_EQ(path("world.move_body", {{"body", 3}, {"position", place}, {"velocity", {0, 0, 2e4}}}),
            "/velocity");
  Json wrong = material(0);
  wrong["density"] = 0;
  EXPECT_EQ(path("world.set_material", {{"material", wrong}}), "/material/density");
  wrong = material(0);
  wrong["colour"] = "red";
  EXPECT_EQ(path("world.set_material", {{"material", wrong}}), "/material/colour");
  EXPECT_EQ(path("world.move_vat", {{"offset", {0, 1.01, 0}}}), "/offset");
}

TEST_F(SessionEdits, OfABodyThatAnotherHoldsWait) {
  const auto other = join();
  const Json grab =
      other->result("grab.start", {{"body", 3}, {"particle", 0}, {"target", {0.7, 0.7, 0.7}}});
  const Json move = {{"body", 3}, {"position", {0.7, 0.6, 0.7}}};
  EXPECT_EQ(client->error("world.move_body", move).at("data").at("kind"), "busy");
  other->result("world.move_body", move);
  other->result("grab.end", {{"grab", grab.at("grab")}});
  client->result("world.move_body", move);
}

TEST_F(SessionEdits, OfAPausedSessionAreShownAtOnce) {
  client->result("frames.subscribe");
  const auto ball_at = [](const GridFrame& frame, double x) {
    for (const GridBlock& block : frame.blocks) {
      if (block.body == 3) return std::abs(place_of(frame, block)[0] - x) < 0.01;
    }
    return false;
  };
  client->wait_frame([&](const GridFrame& frame) { return ball_at(frame, 0.7); });
  client->result("world.move_body", {{"body", 3}, {"position", {0.5, 0.7, 0.7}}});
  client->wait_frame([&](const GridFrame& frame) { return ball_at(frame, 0.5); });
}

TEST_F(SessionEdits, MoveTheVatThatFramesShow) {
  client->result("frames.subscribe");
  client->result("world.move_vat", {{"offset", {0.5, 0, 0}}});
  step(100);
  const GridFrame frame =
      client->wait_frame([](const GridFrame& f) { return f.header.tick == 100; });
  EXPECT_NEAR(place_of(frame, frame.blocks.at(0))[0], 0.5, frame.scale.grid.quantum);
}

// Seen from the walls: what pointers do is one command a tick, and the log has it.
TEST_F(SessionEdits, ThatFollowAPointerAreOneForEachThingInATick) {
  client->result("control.set_speed", {{"speed", 0.05}});
  client->result("control.play");
  client->result("frames.subscribe");
  client->wait_frame([](const GridFrame& frame) { return frame.header.tick > 0; });
  std::vector<int> ids;
  for (int i = 1; i <= 5; ++i) {
    ids.push_back(client->send("world.move_vat", {{"offset", {0.01 * i, 0, 0}}}));
    for (const int body : {2, 3}) {
      ids.push_back(client->send("world.move_body",
                                 {{"body", body}, {"position", {0.5, 0.3 * (body - 1), 0.7}}}));
    }
  }
  for (const int id : ids) {
    EXPECT_TRUE(client->wait_reply(id).contains("result"));
  }
}

class KeptEdits : public testing::Test {
 protected:
  const TemporaryFolder temporary;
  const Catalogue catalogue = make_catalogue();
  std::optional<Host> host{std::in_place, catalogue, temporary.file("data"), unhurried_limits()};
};

// By checkpoints, and by the log alone.
TEST_F(KeptEdits, AreThereAfterARestart) {
  Json scene = host->client->result("scene.get").at("scene");
  Json& water = scene.at("materials").at(0);
  water["density"] = 900;
  host->client->result("world.set_material", {{"material", water}});
  host->client->result("world.set_material",
                       {{"material", {{"name", "steel"}, {"density", 7800}}}});
  host->client->result("world.move_vat", {{"offset", {0.4, 0.2, 0}}});
  host->step(3);
  host->client->result("world.move_body", {{"body", 2}, {"position", {0.6, 0.4, 0.8}}});
  host->step(2);
  host->client->result("world.set_numerics", {{"integrator", "runge_kutta_4"}, {"step", 0.001}});
  const Json ball = host->client->result("state.query", {{"bodies", {"ball"}}}).at("bodies").at(0);
  Json motion;
  for (const char* member : {"center_of_mass", "orientation", "velocity", "angular_velocity"}) {
    motion[member] = ball.at(member);
  }
  host->client->result("world.remove_body", {{"body", ball.at("body")}});
  host->client->result("world.add_body", {{"body", scene.at("bodies").at(2)}, {"state", motion}});
  const std::string before = host->hash();
  host->step(4);
  const std::string later = host->hash();
  for (const bool by_log : {false, true}) {
    host.reset();
    if (by_log) {
      Database(temporary.file("data") + "/checkpoints.db", Database::Mode::create)
          .execute("DELETE FROM checkpoints");
    }
    host.emplace(catalogue, temporary.file("data"), unhurried_limits());
    EXPECT_TRUE(host->client->events("session.diverged").empty());
    EXPECT_EQ(host->hash(), later);
    EXPECT_EQ(host->tick(), 9U);
  }
  EXPECT_NE(before, later);
}

TEST(EditLimits, HoldForSpringsOfAMaterial) {
  ServerLimits limits = unhurried_limits();
  const Catalogue catalogue = make_catalogue();
  limits.max_springs = Simulation::create(to_scene(mixed_scene_text())).value().spring_count();
  Host host(catalogue, "", limits);
  Json rubber = host.client->result("scene.get").at("scene").at("materials").at(1);
  rubber["springs"]["structural"]["stiffness"] = 600;
  host.client->result("world.set_material", {{"material", rubber}});
  const std::string before = host.hash();
  rubber["springs"]["shear"] = {{"stiffness", 100}, {"damping", 1}};
  EXPECT_EQ(host.client->error("world.set_material", {{"material", rubber}}).at("data").at("limit"),
            "springs");
  EXPECT_EQ(host.hash(), before);
}

class StateConnections : public SessionTest {};

TEST_F(StateConnections, AreThoseOfTheSimulation) {
  Simulation reference = Simulation::create(to_scene(mixed_scene_text())).value();
  client->result("world.move_body",
                 {{"body", 3}, {"position", {0.3, 0.5, 0.7}}, {"velocity", {0, -1, 0}}});
  client->result("control.step", {{"ticks", 2}});
  ASSERT_TRUE(reference.move_body(3, {{0.3, 0.5, 0.7}, {}, Vec3(0, -1, 0)}).ok());
  advance_ticks(reference, 2);
  const Connections expected = reference.connections({{}, 10'000}).value();
  ASSERT_GT(expected.contacts.total, 0U) << "the ball touches the cube";
  const Json told = client->result("state.connections", {{"most", 10'000}});
  EXPECT_EQ(told.at("tick"), 2);
  EXPECT_EQ(told.at("time"), reference.time());
  const auto compare = [](const ConnectionList& list, const Json& json, const char* values) {
    EXPECT_EQ(json.at("total"), list.total);
    EXPECT_EQ(json.at("every"), 1);
    ASSERT_EQ(json.at("pairs").size(), 4 * list.sample.size());
    ASSERT_EQ(json.at(values).size(), list.sample.size());
    for (std::size_t i = 0; i < list.sample.size(); ++i) {
      const ConnectedPair& one = list.sample[i];
      EXPECT_EQ(json.at("pairs").at(4 * i), one.a.body);
      EXPECT_EQ(json.at("pairs").at(4 * i + 1), one.a.particle);
      EXPECT_EQ(json.at("pairs").at(4 * i + 2), one.b.body);
      EXPECT_EQ(json.at("pairs").at(4 * i + 3), one.b.particle);
      EXPECT_NEAR(json.at(values).at(i).get<double>(), one.value, 5e-4 * std::abs(one.value));
    }
  };
  compare(expected.springs, told.at("springs"), "strains");
  compare(expected.contacts, told.at("contacts"), "forces");
  EXPECT_EQ(client->result("state.connections", {{"body", "cube"}}).at("springs").at("total"),
            expected.springs.total);
  EXPECT_EQ(client->result("state.connections", {{"body", 1}}).at("springs").at("total"), 0);
  EXPECT_EQ(client->error("state.connections", {{"body", "none"}}).at("data").at("path"), "/body");
  EXPECT_EQ(hash(), hash_of(reference)) << "who asks changes nothing";
}

TEST_F(StateConnections, AreAsManyAsWereAskedForAtMost) {
  const std::size_t total = client->result("state.connections").at("springs").at("total");
  ASSERT_GT(total, 5U);
  const Json some = client->result("state.connections", {{"most", 5}}).at("springs");
  EXPECT_EQ(some.at("total"), total);
  EXPECT_EQ(some.at("every"), (total + 4) / 5);
  EXPECT_LE(some.at("strains").size(), 5U);
  client->result("state.connections", {{"most", kMaxConnections}});
  for (const std::size_t most : {std::size_t{0}, kMaxConnections + 1}) {
    EXPECT_EQ(client->error("state.connections", {{"most", most}}).at("data").at("path"), "/most");
  }
}

class StatsWithDiagnostics : public SessionTest {};

TEST_F(StatsWithDiagnostics, HaveTheSumsOfTheSimulation) {
  EXPECT_FALSE(client->result("session.stats").contains("diagnostics"));
  Simulation reference = Simulation::create(to_scene(mixed_scene_text())).value();
  client->result("control.step", {{"ticks", 10}});
  advance_ticks(reference, 10);
  const Json stats = client->result("session.stats", {{"diagnostics", true}});
  EXPECT_EQ(stats.at("time"), reference.time());
  EXPECT_GE(stats.at("real_time_factor"), 0);
  const Diagnostics expected = reference.diagnostics();
  const Json& told = stats.at("diagnostics");
  EXPECT_EQ(told.at("kinetic_energy"), expected.kinetic_energy);
  EXPECT_EQ(told.at("gravitational_energy"), expected.gravitational_energy);
  EXPECT_EQ(told.at("elastic_energy"), expected.elastic_energy);
  EXPECT_EQ(told.at("contact_energy"), expected.contact_energy);
  EXPECT_EQ(told.at("mean_density_error"), expected.mean_density_error);
  EXPECT_EQ(told.at("max_density_error"), expected.max_density_error);
  Vec3 momentum = Vec3::Zero();
  for (const BodyDiagnostics& body : expected.bodies) momentum += body.linear_momentum;
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(told.at("momentum").at(static_cast<std::size_t>(axis)), momentum[axis]);
  }
  EXPECT_LT(momentum.z(), 0) << "it falls";
  EXPECT_EQ(hash(), hash_of(reference)) << "who asks changes nothing";
}

}  // namespace
}  // namespace vat::test::session_edit_test
