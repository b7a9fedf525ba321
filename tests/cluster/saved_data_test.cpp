// Saved states and scenes that all nodes of a cluster share.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <thread>

#include "tests/cluster/saved_data_nodes.h"
#include "tests/support/wait.h"

namespace vat::test::saved_data_test {
namespace {

using testing::ElementsAre;

/// Returns the kind of the StorageError that `work` throws, if any.
std::optional<StorageError::Kind> kind_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const StorageError& error) {
    return error.kind();
  }
  return {};
}

TEST_F(SavedData, EachNodeHasTheSameListAndContents) {
  constexpr std::size_t kChunk = SavedContents::kChunkBytes;
  for (const std::size_t bytes : {std::size_t{3}, kChunk, kChunk + 1, 3 * kChunk + 5}) {
    const SavedState state = make_state("n", bytes);
    EXPECT_FALSE(a.states.write("s1", state, kManyStates)) << bytes;
    const auto found = b.states.find("s1", "n");
    ASSERT_TRUE(found) << bytes;
    EXPECT_EQ(found->fields, state.fields) << bytes;
    EXPECT_TRUE(found->state == state.state) << bytes;
  }
  EXPECT_EQ(contents().size(), 1U) << "those of replaced states are removed";
  EXPECT_FALSE(b.states.write("s1", make_state("m"), kManyStates));
  EXPECT_THAT(names_of(a.states.list("s1")), ElementsAre("m", "n"));
  EXPECT_TRUE(b.states.remove("s1", "n"));
  EXPECT_THAT(names_of(a.states.list("s1")), ElementsAre("m"));
  EXPECT_EQ(text_of(b.scenes.write(make_scene("sea"), kManyScenes, forbid)), "added");
  EXPECT_THAT(names_of(a.scenes.list()), ElementsAre("sea"));
  EXPECT_EQ(text_of(a.scenes.write(make_scene("sea"), kManyScenes, forbid)), "refused");
  EXPECT_EQ(a.scenes.remove("sea", permit), SceneChange::removed);
  EXPECT_TRUE(b.scenes.list().empty());
  EXPECT_EQ(contents().size(), 1U);
}

// Each node counts the states that another node writes at the same time.
TEST_F(SavedData, TwoNodesDoNotExceedALimitTogether) {
  const SavedStateLimits limits{100, 1000, 50};  // five states
  std::atomic<int> written = 0;
  const auto write = [&](SavingNode& node, const std::string& session) {
    for (int i = 0; i < 5; ++i) {
      const auto excess = node.states.write(session, make_state(std::to_string(i)), limits);
      if (!excess) ++written;
    }
  };
  std::thread other([&] { write(b, "s2"); });
  write(a, "s1");
  other.join();
  EXPECT_EQ(written, 5);
  EXPECT_EQ(a.states.list("s1").size() + a.states.list("s2").size(), 5U);
  EXPECT_EQ(contents().size(), 5U);
}

// A group of servers orders concurrent changes after it has checked them.
TEST(SavedDataOfAGroup, ConcurrentChangesFollowEachOther) {
  const ManualClock clock;
  const NatsServers servers{3};
  SavingNode a{servers, clock};
  SavingNode b{servers, clock};
  const SavedStateLimits limits{100, 1000, 150};  // fifteen states
  std::atomic<int> written = 0;
  const auto write = [&](SavingNode& node, const std::string& session) {
    for (int i = 0; i < 10; ++i) {
      const auto excess = node.states.write(session, make_state(std::to_string(i)), limits);
      if (!excess) ++written;
    }
  };
  std::thread other([&] { write(b, "s2"); });
  write(a, "s1");
  other.join();
  EXPECT_EQ(written, 15);
  for (SavingNode* const node : {&a, &b}) {
    EXPECT_EQ(node->states.list("s1").size() + node->states.list("s2").size(), 15U);
  }
}

TEST_F(SavedData, TwoNodesDoNotBothAddAScene) {
  for (int i = 0; i < 5; ++i) {
    const std::string name = std::to_string(i);
    std::atomic<int> added = 0;
    const auto write = [&](SavingNode& node) {
      if (text_of(node.scenes.write(make_scene(name), kManyScenes, forbid)) == "added") ++added;
    };
    std::thread other([&] { write(b); });
    write(a);
    other.join();
    EXPECT_EQ(added, 1) << i;
  }
}

TEST_F(SavedData, StatesGoWithTheirSession) {
  for (const char* session : {"s1", "s11", "s2"}) {
    EXPECT_FALSE(a.states.write(session, make_state("n"), kManyStates));
    EXPECT_FALSE(a.states.write(session, make_state("m"), kManyStates));
  }
  b.states.remove_session("s1");
  EXPECT_TRUE(a.states.list("s1").empty());
  EXPECT_EQ(a.states.list("s11").size(), 2U);
  EXPECT_EQ(contents().size(), 4U);
  // A node that ended a session could not remove its states.
  const SavedStateLimits full{10, 1000, 40};
  EXPECT_EQ(name_of(a.states.write("s2", make_state("o"), full)), "state_bytes_in_all");
  a.ended = {"s11"};
  EXPECT_EQ(name_of(a.states.write("s2", make_state("o"), full)), "none");
  EXPECT_TRUE(a.states.list("s11").empty());
  EXPECT_THAT(names_of(b.states.list("s2")), ElementsAre("m", "n", "o"));
  EXPECT_EQ(contents().size(), 3U);
}

// A node may end between the write of a content and that of its entry.
TEST_F(SavedData, ContentsWithoutEntriesAreRemovedLater) {
  SavedContents unfinished(a.connection, clock);
  const std::string place = unfinished.write("s1", "a part");
  EXPECT_EQ(unfinished.read(place, 6), "a part");
  const auto write = [&](const std::string& name) {
    EXPECT_FALSE(b.states.write("s1", make_state(name), kManyStates));
    return contents().size();
  };
  EXPECT_EQ(write("a"), 2U);
  clock.advance(std::chrono::minutes(SavedContents::kUnusedMinutes - 1));
  EXPECT_EQ(write("b"), 3U);
  clock.advance(std::chrono::minutes(1));
  EXPECT_EQ(write("c"), 3U) << "the unfinished one is removed";
  EXPECT_THROW(unfinished.read(place, 6), StorageError);
  EXPECT_EQ(a.states.find("s1", "a")->state, make_state("a").state);
}

TEST_F(SavedData, AMissingPartIsDamage) {
  EXPECT_FALSE(a.states.write("s1", make_state("n"), kManyStates));
  EXPECT_EQ(text_of(a.scenes.write(make_scene("n"), kManyScenes, forbid)), "added");
  Stream stream(a.connection, {"vat-saved", "vat.saved.>", Stream::Milliseconds(0), 0, {}});
  stream.purge("vat.saved.>");
  EXPECT_EQ(kind_of([&] { b.states.find("s1", "n"); }), StorageError::Kind::corrupt);
  EXPECT_EQ(kind_of([&] { b.scenes.find("n"); }), StorageError::Kind::corrupt);
}

// Marks of removed entries do not accumulate, and a node that missed them reads the whole list.
TEST_F(SavedData, OldMarksOfRemovedEntriesAreDropped) {
  SavedIndex first(a.connection, 8);
  SavedIndex second(b.connection, 8);
  const auto put = [&](const std::string& key, bool exists) {
    first.change([&](const auto&) {
      return std::optional(
          SavedIndex::Change{key, exists ? std::optional(Json::object()) : std::nullopt});
    });
  };
  const auto keys_at = [](SavedIndex& index) {
    std::vector<std::string> keys;
    index.read([&](const SavedEntries& entries) {
      for (const auto& [key, entry] : entries) keys.push_back(key);
    });
    return keys;
  };
  put("remains", true);
  put("goes", true);
  EXPECT_THAT(keys_at(second), ElementsAre("goes", "remains"));
  put("goes", false);
  for (int i = 0; i < 20; ++i) {
    put("key" + std::to_string(i), true);
    put("key" + std::to_string(i), false);
  }
  EXPECT_THAT(keys_at(second), ElementsAre("remains"));
  Stream stream(a.connection, {"KV_vat-saved", "$KV.vat-saved.>", Stream::Milliseconds(0), 1, {}});
  EXPECT_LE(stream.subjects("$KV.vat-saved.>").size(), 1U + 8U);
}

TEST_F(SavedData, WithoutNatsOrALeaseNothingIsStored) {
  EXPECT_FALSE(a.states.write("s1", make_state("n"), kManyStates));
  const struct {
    const char* name;
    std::function<void()> work;
    bool is_read;
  } cases[] = {
      {"session.save", [&] { a.states.write("s1", make_state("m"), kManyStates); }, false},
      {"session.delete_save", [&] { a.states.remove("s1", "n"); }, false},
      {"session.saves", [&] { a.states.list("s1"); }, true},
      {"session.load", [&] { a.states.find("s1", "n"); }, true},
      {"scene.save", [&] { a.scenes.write(make_scene("x"), kManyScenes, permit); }, false},
      {"scene.delete", [&] { a.scenes.remove("x", permit); }, false},
      {"scene.list", [&] { a.scenes.list(); }, true},
      {"scene.load", [&] { a.scenes.find("x"); }, true},
  };
  a.gate.open = false;
  for (const auto& one : cases) {
    EXPECT_EQ(kind_of(one.work) == StorageError::Kind::unreachable, !one.is_read) << one.name;
  }
  a.gate.open = true;
  EXPECT_THAT(names_of(b.states.list("s1")), ElementsAre("n"));
  servers.kill(0);
  ASSERT_TRUE(wait_until([&] { return !a.connection.is_connected(); }));
  for (const auto& one : cases) {
    EXPECT_EQ(kind_of(one.work), StorageError::Kind::unreachable) << one.name;
  }
  servers.restart(0);
  ASSERT_TRUE(wait_until([&] { return a.connection.is_connected(); }));
  EXPECT_THAT(names_of(a.states.list("s1")), ElementsAre("n"));
}

}  // namespace
}  // namespace vat::test::saved_data_test
