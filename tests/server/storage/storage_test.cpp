// Saved states and scenes, the data folder, and the storage thread.

#include <gtest/gtest.h>

#include <atomic>

#include "server/storage/checkpoint_store.h"
#include "server/storage/data_folder.h"
#include "server/storage/saved/saved_scene_database.h"
#include "server/storage/storage.h"
#include "tests/support/manual_clock.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::storage_test {
namespace {

TEST(StorageStates, GoWithTheSessionsThatAreGone) {
  SavedStateDatabase states(MainDatabase::kInMemory);
  const SavedStateLimits limits{10, 1000, 1000};
  for (const char* session : {"s1", "s2"}) {
    SavedState state;
    state.entry.name = "n";
    state.state = {1};
    EXPECT_FALSE(states.write(session, state, limits));
  }
  states.keep_only({"s1", "s3"});
  EXPECT_EQ(states.list("s1").size(), 1U);
  EXPECT_TRUE(states.list("s2").empty());
}

TEST(StorageScenes, KeysOfAnotherSizeAreDamaged) {
  const auto main = std::make_shared<MainDatabase>(MainDatabase::kInMemory);
  SavedSceneDatabase scenes(main);
  SavedScene scene;
  scene.entry.name = "n";
  const auto written = scenes.write(scene, {1, 1000, 1, 1000}, {});
  EXPECT_EQ(std::get<SceneChange>(written), SceneChange::added);
  EXPECT_TRUE(scenes.find("n"));
  for (const char* key : {"zeroblob(0)", "zeroblob(31)", "zeroblob(33)"}) {
    main->database.prepare("UPDATE scenes SET key = " + std::string(key)).run();
    EXPECT_THROW(scenes.find("n"), StorageError) << key;
  }
}

/// Opens a folder that cannot be used. Returns the kind and the text of the error.
std::pair<StorageError::Kind, std::string> failure_of(const std::string& path) {
  try {
    const DataFolder folder(path);
  } catch (const StorageError& error) {
    return {error.kind(), error.what()};
  }
  return {StorageError::Kind::failed, "opened"};
}

TEST(StorageFolder, IsOneServersAtATimeAndMustBeWritable) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("data");
  {
    const DataFolder first(path);
    EXPECT_EQ(failure_of(path),
              std::pair(StorageError::Kind::locked, path + " is used by another server"));
  }
  const DataFolder second(path);
  const auto [kind, text] = failure_of("/proc/vat");  // not writable, even for root
  EXPECT_EQ(kind, StorageError::Kind::read_only);
  EXPECT_TRUE(text.starts_with("/proc/vat cannot be written")) << text;
}

Checkpoint first_checkpoint(std::uint64_t session) {
  return {session, 1, 2, R"({"playing":true})", std::vector<std::uint8_t>(10, 1)};
}

TEST(Storage, FreesTheSpaceOfClosedSessions) {
  const test::TemporaryFolder folder;
  test::ManualClock clock;
  std::uint64_t kept = 0;
  {
    Storage storage(folder.file("data"), {}, clock);
    const LogEntry first{1, 0, 0, 0, "scene.load", "{}", false};
    const StoredSession session{0, "name", "avx2", "{}", 0, {}};
    const std::uint64_t closed = storage.sessions().create(session, first);
    kept = storage.sessions().create(session, first);
    storage.checkpoints().write(first_checkpoint(closed));
    storage.checkpoints().write(first_checkpoint(kept));
    storage.sessions().close(closed);
    storage.remove_closed();
  }
  Storage storage(folder.file("data"), {}, clock);
  EXPECT_TRUE(storage.sessions().read(1, 0).empty());
  EXPECT_TRUE(storage.checkpoints().places(1).empty());
  EXPECT_EQ(storage.sessions().read(kept, 0).size(), 1U);
  EXPECT_EQ(storage.checkpoints().places(kept).size(), 1U);
}

/// A clock with late timers: a cancelled task is already queued.
class LateClock final : public Clock {
 public:
  SteadyClock::time_point now() const override { return {}; }
  double wall_time() const override { return 0; }
  std::unique_ptr<Timer> make_timer(boost::asio::any_io_executor executor) override {
    class LateTimer final : public Timer {
     public:
      LateTimer(std::atomic<int>& starts, boost::asio::any_io_executor executor)
          : starts_(starts), executor_(std::move(executor)) {}
      void start(SteadyClock::time_point, std::function<void()> task) override {
        ++starts_;
        task_ = std::move(task);
      }
      void cancel() override { boost::asio::post(executor_, task_); }

     private:
      std::atomic<int>& starts_;
      const boost::asio::any_io_executor executor_;
      std::function<void()> task_;
    };
    return std::make_unique<LateTimer>(starts, std::move(executor));
  }

  std::atomic<int> starts = 0;
};

// A timer that restarts would keep the storage thread running forever.
TEST(Storage, StartsNoTimerAtItsEnd) {
  const test::TemporaryFolder folder;
  LateClock clock;
  { const Storage storage(folder.file("data"), {}, clock); }
  EXPECT_EQ(clock.starts, 1);
}

TEST(Storage, MovesItsLogsEverySecond) {
  const test::TemporaryFolder folder;
  test::ManualClock clock;
  Storage storage(folder.file("data"), {}, clock);
  const std::string log = folder.file("data") + "/vat.db-wal";
  const LogEntry first{1, 0, 0, 0, "scene.load", "{}", false};
  const StoredSession session{0, "name", "avx2", "{}", 0, {}};
  const auto write = [&] {
    storage.sessions().create(session, first);
    return std::filesystem::file_size(log);
  };
  clock.advance(std::chrono::milliseconds(999));
  const auto small = write();
  const auto larger = write();
  EXPECT_GT(larger, small);
  clock.advance(std::chrono::milliseconds(1));
  write();
  EXPECT_EQ(std::filesystem::file_size(log), larger) << "the log is reused from its start";
}

TEST(Storage, AnExceptionIsCountedAndTheNextTaskRuns) {
  const test::TemporaryFolder folder;
  test::ManualClock clock;
  bool ran = false;
  {
    Storage storage(folder.file("data"), {}, clock);
    storage.post([] { throw StorageError(StorageError::Kind::full, "the disk is full"); });
    storage.post([&] { ran = storage.counts().failures == 1; });
  }
  EXPECT_TRUE(ran);
}

}  // namespace
}  // namespace vat::test::storage_test
