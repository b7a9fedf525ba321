// Scenes that users save.

#include "tests/server/directory/saved_states_fixture.h"

namespace vat::test::session_saved_scenes_test {
namespace {

class SavedScenesTest : public SavedStatesTest {
 protected:
  /// Returns the entry of scene.list; null if there is none.
  Json listed(const std::string& name) {
    const Json scenes = client().result("scene.list").at("scenes");
    for (const Json& one : scenes) {
      if (one.at("name") == name) return one;
    }
    return nullptr;
  }
  std::string save(const std::string& name) {
    return client().result("scene.save", {{"name", name}, {"scene", scene}}).at("key");
  }

  const Json scene = Json::parse(R"({"format": "vat.scene/1", "title": "A ball",
      "materials": [{"name": "wood", "density": 600}],
      "bodies": [{"name": "ball", "kind": "rigid", "material": "wood", "spacing": 0.1,
                  "shape": {"type": "sphere", "radius": 0.1}}]})");
};

TEST_P(SavedScenesTest, AreUsedLikeThoseOfTheCatalogue) {
  save("my ball");
  const Json entry = listed("my ball");
  ASSERT_TRUE(entry.is_object());
  EXPECT_EQ(entry.at("title"), "A ball");
  EXPECT_EQ(entry.at("saved_by"), "Ada");
  EXPECT_GT(entry.at("saved"), 1e9);
  EXPECT_FALSE(listed("mixed").contains("saved_by"));
  client().result("scene.load", {{"scene", scene}});
  const std::string ball = host->hash();
  client().result("scene.load", {{"scene", "mixed"}});
  client().result("scene.load", {{"scene", "my ball"}});
  EXPECT_EQ(host->hash(), ball);
  client().result("session.join", {{"session", client().create_session("my ball")}});
  client().result("control.pause");
  client().result("control.reset");
  EXPECT_EQ(host->hash(), ball);
}

TEST_P(SavedScenesTest, WithoutASceneTheInitialOneIsSaved) {
  client().result("control.reset");
  const std::string start = host->hash();
  host->step(3);
  client().result("world.remove_body", {{"body", 2}});
  client().result("scene.save", {{"name", "mine"}});
  client().result("scene.load", {{"scene", "mine"}});
  EXPECT_EQ(host->hash(), start);
}

TEST_P(SavedScenesTest, OnlyTheKeyOrAnAdminChangesOne) {
  const std::string key = save("mine");
  for (const Json& params : {Json{{"name", "mine"}}, Json{{"name", "mine"}, {"key", "wrong"}}}) {
    EXPECT_EQ(client().error("scene.save", params).at("code"), 1006);
    EXPECT_EQ(client().error("scene.delete", params).at("code"), 1006);
  }
  EXPECT_EQ(listed("mine").at("title"), "A ball");
  Json other = scene;
  other["title"] = "Another";
  EXPECT_FALSE(client()
                   .result("scene.save", {{"name", "mine"}, {"key", key}, {"scene", other}})
                   .contains("key"));
  EXPECT_EQ(listed("mine").at("title"), "Another");
  client().result("scene.delete", {{"name", "mine"}, {"key", key}});
  EXPECT_TRUE(listed("mine").is_null());
  EXPECT_EQ(client().error("scene.delete", {{"name", "mine"}, {"key", key}}).at("data").at("kind"),
            "no_such_scene");
  save("mine");
  client().result("access.enter", {{"token", kAdminToken}});
  client().result("scene.delete", {{"name", "mine"}});
  EXPECT_TRUE(listed("mine").is_null());
}

TEST_P(SavedScenesTest, RefusesInvalidScenes) {
  EXPECT_EQ(client().error("scene.save", {{"name", "mixed"}, {"scene", scene}}).at("code"), 1006);
  EXPECT_EQ(client().error("scene.save", {{"name", "x"}, {"scene", "mixed"}}).at("data").at("path"),
            "/scene");
  EXPECT_EQ(client().error("scene.save", {{"name", ""}, {"scene", scene}}).at("data").at("path"),
            "/name");
  Json broken = scene;
  broken["bodies"][0]["material"] = "none";
  EXPECT_EQ(client().error("scene.save", {{"name", "x"}, {"scene", broken}}).at("data").at("path"),
            "/scene/bodies/0/material");
  EXPECT_TRUE(listed("x").is_null());
}

TEST_P(SavedScenesTest, CountAndBytesAreLimited) {
  client().result("scene.save", {{"name", "size"}, {"scene", scene}});
  host.reset();
  const auto refused = [&](TestClient& who, const std::string& limit) {
    const Json error = who.error("scene.save", {{"name", "beyond"}, {"scene", scene}});
    EXPECT_EQ(error.at("data").at("kind"), "limit_reached");
    EXPECT_EQ(error.at("data").at("limit"), limit);
  };
  const auto elsewhere = [&] {
    auto other = std::make_unique<TestClient>(host->server, 2, "10.0.0.2");
    other->result("session.join");
    return other;
  };
  std::filesystem::remove_all(temporary.file("data"));
  limits.max_scenes_per_address = 2;
  limits.max_scenes_in_all = 3;
  restart(limits);
  save("one");
  const std::size_t bytes =
      client().result("scene.save", {{"name", "two"}, {"scene", scene}}).at("bytes");
  refused(client(), "scenes_per_address");
  {
    const auto other = elsewhere();
    other->result("scene.save", {{"name", "three"}, {"scene", scene}});
    refused(*other, "scenes_in_all");
  }
  host.reset();
  std::filesystem::remove_all(temporary.file("data"));
  limits = unhurried_limits();
  limits.max_scene_bytes_per_address = 2 * bytes + bytes / 2;
  limits.max_scene_bytes_in_all = 3 * bytes + bytes / 2;
  restart(limits);
  save("one");
  save("two");
  refused(client(), "scene_bytes_per_address");
  const auto other = elsewhere();
  other->result("scene.save", {{"name", "three"}, {"scene", scene}});
  refused(*other, "scene_bytes_in_all");
}

TEST_P(SavedScenesTest, OneThatIsReplacedStaysThatOfItsAddress) {
  limits.max_scenes_per_address = 1;
  restart();
  const Json saved = client().result("scene.save", {{"name", "one"}});
  TestClient other(host->server, 20, "127.0.0.9");
  other.result("session.join", {{"session", "s1"}});
  other.result("scene.save", {{"name", "one"}, {"key", saved.at("key")}});
  other.result("scene.save", {{"name", "two"}});
  EXPECT_EQ(client().error("scene.save", {{"name", "three"}}).at("data").at("limit"),
            "scenes_per_address");
}

TEST_P(SavedScenesTest, AreThereAfterARestartAndSoAreSessionsOfThem) {
  const std::string key = save("mine");
  client().result("scene.load", {{"scene", "mine"}});
  host->step(5);
  const std::string before = host->hash();
  client().result("scene.delete", {{"name", "mine"}, {"key", key}});
  save("other");
  restart();
  EXPECT_TRUE(listed("mine").is_null());
  EXPECT_EQ(listed("other").is_object(), GetParam());
  EXPECT_EQ(host->hash() == before, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Storage, SavedScenesTest, testing::Bool(),
                         [](const auto& test) { return test.param ? "Folder" : "Memory"; });

}  // namespace
}  // namespace vat::test::session_saved_scenes_test
