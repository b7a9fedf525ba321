// Claims that hold for the saved data of a data folder and for that of a cluster.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/storage/saved/saved_scene_database.h"
#include "server/storage/saved/saved_state_database.h"
#include "tests/cluster/saved_data_nodes.h"

namespace vat::test::saved_stores_test {
namespace {

using testing::ElementsAre;

/// Stores of a data folder and of a cluster. The parameter chooses one.
class SavedStores : public SavedData, public testing::WithParamInterface<bool> {
 protected:
  SavedStateDatabase state_database{MainDatabase::kInMemory};
  SavedSceneDatabase scene_database{std::make_shared<MainDatabase>(MainDatabase::kInMemory)};
  SavedStates& states = GetParam() ? static_cast<SavedStates&>(a.states) : state_database;
  SavedScenes& scenes = GetParam() ? static_cast<SavedScenes&>(a.scenes) : scene_database;
};

TEST_P(SavedStores, StatesAreListedReplacedAndRemoved) {
  EXPECT_TRUE(states.list("s1").empty());
  for (const char* name : {"b", "a", "\xc3\xa4", "a b.>*"}) {
    EXPECT_FALSE(states.write("s1", make_state(name), kManyStates));
  }
  EXPECT_FALSE(states.write("s11", make_state("other"), kManyStates));
  EXPECT_THAT(names_of(states.list("s1")), ElementsAre("a", "a b.>*", "b", "\xc3\xa4"));
  const SavedState larger = make_state("b", 33);
  EXPECT_FALSE(states.write("s1", larger, kManyStates));
  EXPECT_EQ(states.list("s1").size(), 4U);
  const auto found = states.find("s1", "b");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->fields, larger.fields);
  EXPECT_EQ(found->state, larger.state);
  EXPECT_EQ(found->entry.saved_by, "Ada");
  EXPECT_EQ(found->entry.time, 1.5);
  EXPECT_EQ(found->entry.tick, 7U);
  EXPECT_EQ(found->entry.simulation_time, 0.25);
  EXPECT_EQ(found->entry.hash, 0xfedcba9876543210);
  EXPECT_EQ(found->entry.bytes, 33U);
  EXPECT_TRUE(states.remove("s1", "b"));
  EXPECT_FALSE(states.remove("s1", "b"));
  EXPECT_FALSE(states.find("s1", "b"));
  EXPECT_FALSE(states.find("s11", "a"));
  EXPECT_EQ(states.list("s1").size(), 3U);
}

TEST_P(SavedStores, StatesAreLimited) {
  const SavedStateLimits limits{2, 50, 70};
  EXPECT_EQ(name_of(states.write("s1", make_state("a", 51), limits)), "state_bytes_per_session");
  EXPECT_EQ(name_of(states.write("s1", make_state("a", 50), limits)), "none");
  EXPECT_EQ(name_of(states.write("s1", make_state("b", 3), limits)), "state_bytes_per_session");
  EXPECT_EQ(name_of(states.write("s1", make_state("a", 47), limits)), "none");
  EXPECT_EQ(name_of(states.write("s1", make_state("b", 3), limits)), "none");
  EXPECT_EQ(name_of(states.write("s1", make_state("c", 3), limits)), "states_per_session");
  EXPECT_EQ(name_of(states.write("s2", make_state("c", 21), limits)), "state_bytes_in_all");
  EXPECT_EQ(name_of(states.write("s2", make_state("c", 20), limits)), "none");
  EXPECT_THAT(names_of(states.list("s1")), ElementsAre("a", "b"));
}

TEST_P(SavedStores, ScenesAreReplacedWithPermissionOnly) {
  EXPECT_EQ(text_of(scenes.write(make_scene("sea"), kManyScenes, forbid)), "added");
  SavedScene other = make_scene("sea", "10.0.0.2", 20);
  other.key = hash_of_token("another key");
  EXPECT_EQ(text_of(scenes.write(other, kManyScenes, forbid)), "refused");
  EXPECT_EQ(scenes.find("sea")->scene.size(), 10U);
  const auto has_key = [](const SceneKey& key) { return are_same(key, hash_of_token("sea")); };
  EXPECT_EQ(text_of(scenes.write(other, kManyScenes, has_key)), "replaced");
  const auto found = scenes.find("sea");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->scene, other.scene);
  EXPECT_EQ(found->address, "10.0.0.1") << "of the creator";
  EXPECT_EQ(found->key, hash_of_token("sea"));
  EXPECT_EQ(found->entry.title, "Title");
  EXPECT_EQ(found->entry.description, "Text");
  EXPECT_EQ(found->entry.saved_by, "Ada");
  EXPECT_EQ(found->entry.bytes, 20U);
  EXPECT_EQ(text_of(scenes.write(make_scene("lake"), kManyScenes, forbid)), "added");
  EXPECT_THAT(names_of(scenes.list()), ElementsAre("lake", "sea"));
  EXPECT_EQ(scenes.remove("pond", permit), SceneChange::absent);
  EXPECT_EQ(scenes.remove("sea", forbid), SceneChange::refused);
  EXPECT_EQ(scenes.remove("sea", has_key), SceneChange::removed);
  EXPECT_THAT(names_of(scenes.list()), ElementsAre("lake"));
  EXPECT_FALSE(scenes.find("sea"));
}

TEST_P(SavedStores, ScenesAreLimited) {
  const SavedSceneLimits limits{2, 50, 3, 70};
  const auto write = [&](const char* name, const char* address, std::size_t bytes) {
    return text_of(scenes.write(make_scene(name, address, bytes), limits, permit));
  };
  EXPECT_EQ(write("a", "1", 51), "scene_bytes_per_address");
  EXPECT_EQ(write("a", "1", 50), "added");
  EXPECT_EQ(write("a", "1", 49), "replaced");
  EXPECT_EQ(write("b", "1", 1), "added");
  EXPECT_EQ(write("c", "1", 0), "scenes_per_address");
  EXPECT_EQ(write("c", "2", 21), "scene_bytes_in_all");
  EXPECT_EQ(write("c", "2", 1), "added");
  EXPECT_EQ(write("d", "2", 1), "scenes_in_all");
  EXPECT_THAT(names_of(scenes.list()), ElementsAre("a", "b", "c"));
}

INSTANTIATE_TEST_SUITE_P(Of, SavedStores, testing::Bool(),
                         [](const auto& test) { return test.param ? "Cluster" : "Folder"; });

}  // namespace
}  // namespace vat::test::saved_stores_test
