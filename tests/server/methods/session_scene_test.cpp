// scene.get: clients read, change and load scenes.

#include "protocol/scene/scene_json.h"
#include "tests/server/fixture/session_fixture.h"

namespace vat::test::session_scene_test {
namespace {

class SceneGet : public SessionTest {
 protected:
  Json get(const Json& params = nullptr) { return client->result("scene.get", params).at("scene"); }
  Json current() { return get({{"current", true}}); }
  std::string hash_from(const Json& scene) {
    client->result("scene.load", {{"scene", scene}});
    return hash();
  }
};

Json ball() {
  return Json::parse(R"({"name": "second", "kind": "rigid", "material": "wood", "spacing": 0.05,
                         "shape": {"type": "sphere", "center": [0.3, 0.3, 0.8], "radius": 0.08}})");
}

TEST_F(SceneGet, ALoadedResultLeadsToTheSameBits) {
  const std::string start = hash();
  client->result("control.step", {{"ticks", 3}});
  client->result("world.remove_body", {{"body", 2}});
  client->result("world.set_gravity", {{"gravity", {1, 0, -9}}});
  const Json scene = get();
  EXPECT_EQ(scene, write_scene(to_scene(mixed_scene_text())));
  EXPECT_EQ(get({{"current", false}}), scene);
  EXPECT_EQ(hash_from(scene), start);
}

TEST_F(SceneGet, TheCurrentOneHasTheChangesOfCommands) {
  EXPECT_EQ(current(), get());
  client->result("world.remove_body", {{"body", 1}});
  client->result("world.add_body", {{"body", ball()}});
  client->result("world.set_gravity", {{"gravity", {1, 0, -9}}});
  client->result("world.set_interface",
                 {{"interface", {{"materials", {"wood", "vat"}}, {"stiffness", 4321}}}});
  const std::string changed = hash();
  const Json scene = current();
  ASSERT_EQ(scene.at("bodies").size(), 3u);
  EXPECT_EQ(scene.at("bodies").at(0).at("name"), "cube");
  EXPECT_EQ(scene.at("bodies").at(2).at("name"), "second");
  EXPECT_EQ(scene.at("gravity"), Json({1.0, 0.0, -9.0}));
  EXPECT_EQ(get().at("bodies").size(), 3u);
  EXPECT_EQ(get().at("bodies").at(0).at("name"), "pool");
  // Nothing has moved yet, so the scene starts in the present state.
  EXPECT_EQ(hash_from(scene), changed);
  EXPECT_EQ(get(), scene);
  client->result("world.set_gravity", {{"gravity", {0, 0, -1}}});
  client->result("control.reset");
  EXPECT_EQ(hash(), changed) << "a reset goes back to the loaded scene";
}

TEST_F(SceneGet, ReturnsASceneOfTheCatalogueOrOfAUser) {
  EXPECT_EQ(get({{"scene", "unstable"}}), write_scene(to_scene(unstable_scene_text())));
  client->result("world.set_gravity", {{"gravity", {0, 0, -1}}});
  client->result("scene.save", {{"name", "slow"}, {"scene", current()}});
  const Json scene = get({{"scene", "slow"}});
  EXPECT_EQ(scene.at("gravity"), Json({0.0, 0.0, -1.0}));
  EXPECT_EQ(scene.at("name"), "slow");
  const Json error = client->error("scene.get", {{"scene", "none"}});
  EXPECT_EQ(error.at("data").at("kind"), "no_such_scene");
  EXPECT_EQ(error.at("data").at("path"), "/scene");
  for (const bool current : {false, true}) {
    const Json both = client->error("scene.get", {{"scene", "mixed"}, {"current", current}});
    EXPECT_EQ(both.at("data").at("path"), "/current");
  }
}

/// Returns the largest value of a limit at which the scene is refused. At `high` it is accepted.
template <class Set>
std::size_t refused_up_to(const Set& set, std::size_t high) {
  std::size_t low = 1000;  // needed by the settings
  while (low + 1 < high) {
    const std::size_t middle = (low + high) / 2;
    (set(middle) ? high : low) = middle;
  }
  return low;
}

class SceneGetLimits : public testing::Test {
 protected:
  /// Returns the error of scene.get under these limits. If there is none, loads the result with
  /// scene.load.
  Json error_of_get(const ServerLimits& limits) {
    TestServer server(catalogue, test_settings(limits));
    EXPECT_TRUE(server.create_session("first", to_scene(mixed_scene_text())));
    TestClient client(server, 1);
    client.result("session.join");
    const Json reply = client.call("scene.get");
    if (reply.contains("error")) return reply.at("error").at("data");
    client.result("scene.load", {{"scene", reply.at("result").at("scene")}});
    return nullptr;
  }

  const Catalogue catalogue = make_catalogue();
};

// Every returned scene can be sent back: reply and loading message have the same limit.
TEST_F(SceneGetLimits, TheResultFitsIntoAMessage) {
  const std::size_t bytes = write_scene(to_scene(mixed_scene_text())).dump().size();
  const std::size_t least = refused_up_to(
      [&](std::size_t most) {
        ServerLimits limits = unhurried_limits();
        limits.max_scene_message_bytes = most;
        const Json error = error_of_get(limits);
        if (!error.is_null()) {
          EXPECT_EQ(error.at("limit"), "scene_message_bytes");
          EXPECT_EQ(error.at("maximum"), most);
        }
        return error.is_null();
      },
      2 * bytes);
  EXPECT_GE(least, bytes);
  EXPECT_LE(least, bytes + 300) << "a scene that fits is not refused";
}

TEST_F(SceneGetLimits, ValuesAreCountedAsThoseOfAMessage) {
  ServerLimits limits = unhurried_limits();
  limits.max_message_values = 50;
  const Json error = error_of_get(limits);
  EXPECT_EQ(error.at("limit"), "message_values");
  const std::string text = write_scene(to_scene(mixed_scene_text())).dump();
  std::size_t values = 50;
  while (!parse_json(text, {text.size(), 16, values})) ++values;
  limits.max_message_values = values + 7;
  EXPECT_EQ(error_of_get(limits).at("limit"), "message_values");
  limits.max_message_values = values + 8;
  EXPECT_TRUE(error_of_get(limits).is_null());
}

}  // namespace
}  // namespace vat::test::session_scene_test
