// Editing a session: moving bodies, changing materials, moving the vat. Queries of springs,
// contacts and energies.

#include "protocol/scene/scene_json.h"
#include "tests/server/fixture/host.h"

namespace vat::test::session_edit_test {
namespace {

class SessionEdits : public SessionTest {};

TEST_F(SessionEdits, BringBackABodyAsItWas) {
  client->result("control.step", {{"ticks", 20}});
  for (const char* name : {"pool", "cube", "ball"}) {
    const Json state = client->result("state.query", {{"bodies", {name}}}).at("bodies").at(0);
    const Json scene = client->result("scene.get", {{"current", true}}).at("scene");
    Json body;
    for (const Json& one : scene.at("bodies")) {
      if (one.at("name") == name) body = one;
    }
    using Members = std::vector<const char*>;
    const bool is_rigid = state.contains("orientation");
    const Members moved =
        is_rigid ? Members{"center_of_mass", "orientation", "velocity", "angular_velocity"}
                 : Members{"positions", "velocities"};
    Json motion;
    for (const char* member : moved) motion[member] = state.at(member);
    client->result("world.remove_body", {{"body", state.at("body")}});
    const Json id =
        client->result("world.add_body", {{"body", body}, {"state", motion}}).at("body");
    const Json back = client->result("state.query", {{"bodies", {name}}}).at("bodies").at(0);
    EXPECT_EQ(back.at("body"), id);
    for (const char* member : is_rigid ? Members{"center_of_mass"} : moved) {
      EXPECT_EQ(back.at(member), state.at(member)) << name;
    }
  }
}

TEST_F(SessionEdits, OfABodyThatAnotherHoldsWait) {
  const auto other = join();
  const std::uint64_t grab = other->grab(3);
  const Json move = {{"body", 3}, {"position", {0.7, 0.6, 0.7}}};
  EXPECT_EQ(client->error("world.move_body", move).at("data").at("kind"), "busy");
  other->result("world.move_body", move);
  other->result("grab.end", {{"grab", grab}});
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

TEST_F(SessionEdits, OfAnAppearanceAreDescribed) {
  const std::string before = hash();
  Json wood = client->result("scene.get").at("scene").at("materials").at(2);
  wood["appearance"] = {{"colour", "#102030"}, {"finish", "brick"}};
  client->result("world.set_material", {{"material", wood}});
  const Json description = client->wait_event("session.description");
  for (const Json& material : description.at("materials")) {
    const Json& appearance = material.at("appearance");
    EXPECT_TRUE(appearance.contains("roughness"));
    EXPECT_EQ(appearance.at("colour") == "#102030", material.at("name") == wood.at("name"));
  }
  EXPECT_EQ(hash(), before);
  const Json scene = client->result("scene.get", {{"current", true}}).at("scene");
  EXPECT_EQ(scene.at("materials").at(2).at("appearance"), wood.at("appearance"));
  wood["appearance"]["roughness"] = -1;
  EXPECT_EQ(client->error("world.set_material", {{"material", wood}}).at("data").at("path"),
            "/material/appearance/roughness");
  client->result("control.reset");
  const Json reset = client->result("scene.get", {{"current", true}}).at("scene");
  EXPECT_FALSE(reset.at("materials").at(2).contains("appearance"));
}

TEST_F(SessionEdits, MoveTheVatThatFramesShow) {
  client->result("frames.subscribe");
  client->result("world.move_vat", {{"offset", {0.5, 0, 0}}});
  client->result("control.step", {{"ticks", 100}});
  const GridFrame frame =
      client->wait_frame([](const GridFrame& f) { return f.header.tick == 100; });
  EXPECT_NEAR(place_of(frame, frame.blocks.at(0))[0], 0.5, frame.scale.grid.quantum);
}

TEST(EditLimits, HoldForSpringsOfAMaterial) {
  ServerLimits limits = unhurried_limits();
  const Catalogue catalogue = make_catalogue();
  limits.max_springs = mixed_simulation().spring_count();
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
  Simulation reference = mixed_simulation();
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
  EXPECT_EQ(hash(), hash_of(reference)) << "queries do not change the state";
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
  Simulation reference = mixed_simulation();
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
  EXPECT_LT(momentum.z(), 0) << "the body falls";
  EXPECT_EQ(hash(), hash_of(reference)) << "queries do not change the state";
}

}  // namespace
}  // namespace vat::test::session_edit_test
