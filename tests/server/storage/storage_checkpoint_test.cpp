// Checkpoints: storage, compression, frequency, and the log that they shorten.

#include "server/history/recorder.h"
#include "server/history/session_log.h"
#include "server/storage/checkpoint_store.h"
#include "server/storage/sqlite/compression.h"
#include "server/storage/storage.h"
#include "tests/server/fixture/session_fixture.h"
#include "tests/server/fixture/test_disk.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::storage_checkpoint_test {
namespace {

using Seconds = CheckpointPace::Seconds;

/// Returns incompressible bytes.
std::vector<std::uint8_t> noise(std::size_t count) {
  std::vector<std::uint8_t> bytes(count);
  std::uint32_t x = 1;
  for (std::uint8_t& b : bytes) {
    x ^= x << 13;
    x ^= x >> 17;
    x ^= x << 5;
    b = static_cast<std::uint8_t>(x >> 24);
  }
  return bytes;
}

Checkpoint checkpoint(std::uint64_t session, std::uint64_t position, std::size_t bytes) {
  return {session, position, position + 1, R"({"playing":true})", noise(bytes)};
}

std::vector<std::uint64_t> positions(CheckpointStore& store, std::uint64_t session) {
  std::vector<std::uint64_t> positions;
  for (const CheckpointPlace& place : store.places(session)) positions.push_back(place.position);
  return positions;
}

class StorageCheckpoints : public testing::Test {
 protected:
  test::TemporaryFolder folder;
  const std::string path = folder.file("checkpoints.db");
};

TEST_F(StorageCheckpoints, AreReadUnchanged) {
  const Checkpoint written = checkpoint(7, 100, 5000);
  CheckpointStore(path, 1 << 20).write(written);
  CheckpointStore store(path, 1 << 20);
  ASSERT_EQ(store.places(7).size(), 1U);
  EXPECT_EQ(store.places(7)[0].sequence, 101U);
  const auto read = store.read(store.places(7)[0]);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->session, 7U);
  EXPECT_EQ(read->position, 100U);
  EXPECT_EQ(read->fields, written.fields);
  EXPECT_EQ(read->state, written.state);
  EXPECT_TRUE(store.places(8).empty());
}

std::vector<std::uint64_t> hash_positions(CheckpointStore& store, std::uint64_t from = 0) {
  std::vector<std::uint64_t> positions;
  for (const TickHash& one : store.hashes(7, from)) {
    EXPECT_EQ(one.hash, one.position * 3);
    positions.push_back(one.position);
  }
  return positions;
}

TEST_F(StorageCheckpoints, HaveHashesUpToTheRestart) {
  {
    CheckpointStore store(path, 1 << 20);
    store.write_hashes(7, std::vector<TickHash>{{1, 3}, {2, 6}, {3, 9}});
    store.write_hashes(8, std::vector<TickHash>{{4, 1}});
    store.write_hashes(7, std::vector<TickHash>{{4, 12}, {5, 15}});
    store.write_hashes(7, std::vector<TickHash>{{6, 18}});
    store.write_hashes(7, {});
  }
  CheckpointStore store(path, 1 << 20);
  EXPECT_EQ(hash_positions(store), (std::vector<std::uint64_t>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(hash_positions(store, 4), (std::vector<std::uint64_t>{4, 5, 6}));
  store.drop_hashes(7, 6);
  EXPECT_EQ(store.hash_count(7), 6U);
  store.drop_hashes(7, 4);
  EXPECT_EQ(hash_positions(store), (std::vector<std::uint64_t>{1, 2, 3, 4}));
  EXPECT_EQ(store.hash_count(7), 4U);
  store.write_hashes(7, std::vector<TickHash>{{CheckpointStore::kMaxHashes + 4,
                                               3 * (CheckpointStore::kMaxHashes + 4)}});
  EXPECT_EQ(hash_positions(store).front(), 4U);  // earlier rows end too far back
  store.keep_only({8});
  EXPECT_EQ(store.hash_count(7), 0U);
  EXPECT_EQ(store.hash_count(8), 1U);
}

TEST_F(StorageCheckpoints, BeyondTheirBytesTheyAreThinnedEvenly) {
  CheckpointStore store(path, 10 * 1000 + 500);
  for (std::uint64_t position = 0; position <= 64; ++position) {
    store.write(checkpoint(1, position, 1000));
  }
  const std::vector<std::uint64_t> kept = positions(store, 1);
  ASSERT_GE(kept.size(), 9U);  // each takes slightly more than 1000 bytes
  ASSERT_LE(kept.size(), 10U);
  EXPECT_EQ(kept.front(), 0U);
  EXPECT_EQ(kept.back(), 64U);
  // Merging the smallest gaps first keeps ten checkpoints. The widest gap is at most four times an
  // even share, since intervals are powers of two.
  for (std::size_t i = 1; i < kept.size(); ++i) EXPECT_LE(kept[i] - kept[i - 1], 4U * 64 / 9);
}

TEST_F(StorageCheckpoints, TheNewestIsKeptAtAnySize) {
  CheckpointStore store(path, 100);
  store.write(checkpoint(1, 5, 1000));
  store.write(checkpoint(2, 1, 50));
  store.write(checkpoint(1, 9, 1000));
  EXPECT_EQ(positions(store, 1), std::vector<std::uint64_t>{9});
  EXPECT_EQ(positions(store, 2), std::vector<std::uint64_t>{1});
}

TEST_F(StorageCheckpoints, ADamagedOneIsReportedByItsKind) {
  CheckpointStore store(path, 1 << 20);
  store.write(checkpoint(1, 1, 1000));
  Database database(path, Database::Mode::create);
  database.execute("UPDATE checkpoints SET state = CAST(substr(state, 1, 900) AS BLOB)");
  try {
    store.read(store.places(1).at(0));
    ADD_FAILURE() << "a damaged checkpoint was read";
  } catch (const StorageError& error) {
    EXPECT_EQ(error.kind(), StorageError::Kind::corrupt);
  }
}

// The recorder does not decompress states. It therefore does not see that this one is damaged.
TEST(StorageRecorder, TakesStoredStatesAsTheyAre) {
  const TemporaryFolder folder;
  ManualClock clock;
  Storage storage(folder.file("data"), {}, clock);
  const LogEntry first{1, 0, 0, 0, "scene.load", "{}", false};
  const std::uint64_t number = storage.sessions().create({0, "name", "avx2", "{}", 0, {}}, first);
  Checkpoint written = checkpoint(number, 100, 1000);
  written.sequence = 1;
  storage.checkpoints().write(written);
  Database database(folder.file("data/checkpoints.db"), Database::Mode::create);
  database.execute("UPDATE checkpoints SET state = CAST(substr(state, 1, 900) AS BLOB)");
  const std::optional<Recording> recording = record_session(storage, number, 1 << 20);
  ASSERT_TRUE(recording);
  ASSERT_EQ(recording->moments.size(), 1U);
  std::vector<std::uint8_t> stored = compress(written.state);
  stored.resize(900);
  EXPECT_EQ(recording->moments[0].state, stored);
}

TEST(StorageCompression, RestoresTheBytesAndRefusesDamagedOrLargeOnes) {
  std::vector<std::uint8_t> bytes = noise(3000);
  bytes.resize(10'000);
  std::vector<std::uint8_t> frame = compress(bytes);
  EXPECT_LT(frame.size(), 4000U);
  EXPECT_EQ(decompress(frame, 10'000), bytes);
  EXPECT_THROW(decompress(frame, 9'999), StorageError);
  EXPECT_THROW(decompress(std::span(frame).first(frame.size() - 1), 10'000), StorageError);
  for (const std::size_t at : {std::size_t{1}, frame.size() / 2, frame.size() - 1}) {
    frame[at] ^= 1;
    EXPECT_THROW(decompress(frame, 10'000), StorageError) << at;
    frame[at] ^= 1;
  }
  EXPECT_TRUE(decompress(compress({}), 0).empty());
}

TEST_F(StorageCheckpoints, OfAllSessionsAreThinnedFromTheLargest) {
  CheckpointStore store(path, 1 << 20, 30'000);
  store.write(checkpoint(1, 10, 5000));
  store.write(checkpoint(1, 20, 5000));
  for (std::uint64_t position = 10; position <= 40; position += 10) {
    store.write(checkpoint(2, position, 5000));
  }
  EXPECT_EQ(positions(store, 1), (std::vector<std::uint64_t>{10, 20}));
  EXPECT_EQ(positions(store, 2), (std::vector<std::uint64_t>{10, 30, 40}));
  CheckpointStore(path, 1 << 20, 100).write(checkpoint(3, 1, 5000));
  EXPECT_EQ(positions(store, 1), std::vector<std::uint64_t>{20});
  EXPECT_EQ(positions(store, 2), std::vector<std::uint64_t>{40}) << "the newest stays";
  EXPECT_EQ(positions(store, 3), std::vector<std::uint64_t>{1});
}

TEST_F(StorageCheckpoints, OfClosedSessionsReturnTheirSpaceToTheSystem) {
  CheckpointStore store(path, 64 << 20);
  store.write(checkpoint(1, 10, 5000));
  const auto small = std::filesystem::file_size(path);
  for (std::uint64_t position = 1; position <= 20; ++position) {
    store.write(checkpoint(2, position, 200'000));
  }
  EXPECT_GT(std::filesystem::file_size(path), small + 4'000'000);
  store.keep_only({1});
  EXPECT_LE(std::filesystem::file_size(path), small + 8192);
  EXPECT_EQ(positions(store, 1), std::vector<std::uint64_t>{10});
  EXPECT_TRUE(store.places(2).empty());
}

// A checkpoint of 200 kB is written once, not also to a write-ahead log.
TEST_F(StorageCheckpoints, AreWrittenOnce) {
  TestDisk disk;
  CheckpointStore store(path, 64 << 20);
  store.write(checkpoint(1, 10, 200'000));
  const std::size_t before = disk.written_bytes();
  store.write(checkpoint(1, 20, 200'000));
  EXPECT_LT(disk.written_bytes() - before, 260'000U);
}

struct Course {
  double share = 0;  ///< fraction of checkpoints in all work
  Seconds longest{0};
};

/// Simulates a session with ticks of `tick` for `length`. A checkpoint takes `cost`.
Course follow(CheckpointPace pace, Seconds tick, Seconds cost, Seconds length,
              std::size_t sessions = 1) {
  Course course;
  Seconds since{0};
  Seconds spent{0};
  for (Seconds work{0}; work < length; work += tick) {
    pace.add_work(tick);
    since += tick;
    course.longest = std::max(course.longest, since);
    if (!pace.is_due(cost, sessions)) continue;
    pace.begin();
    spent += cost;
    since = Seconds(0);
  }
  course.share = spent / length;
  return course;
}

// Sessions share the work of a recovery.
TEST(CheckpointPace, CheapOnesComeAsOftenAsIsWanted) {
  for (const auto& [wanted, sessions] : {std::pair(0.15, 1), std::pair(4.0, 20)}) {
    const Course course = follow(CheckpointPace(Seconds(wanted)), Seconds(0.004), Seconds(0.001),
                                 Seconds(100), static_cast<std::size_t>(sessions));
    EXPECT_LE(course.longest.count(), wanted / sessions + 0.004) << sessions;
    EXPECT_LE(course.share, CheckpointPace::kMaxShare) << sessions;
  }
}

TEST(CheckpointPace, DearOnesTakeTheirShareAndNoMore) {
  for (const double cost : {0.01, 0.02, 0.05, 0.1}) {
    const Course course =
        follow(CheckpointPace(Seconds(0.15)), Seconds(0.004), Seconds(cost), Seconds(1000));
    // Tolerance for a million roundings.
    EXPECT_LE(course.share, CheckpointPace::kMaxShare * (1 + 1e-9)) << cost;
    // At least the share minus one tick per checkpoint interval.
    EXPECT_GE(course.share, CheckpointPace::kMaxShare * 0.97 - cost / 1000) << cost;
  }
}

TEST(CheckpointPace, SomeAreWrittenAtAnyCost) {
  const Course course =
      follow(CheckpointPace(Seconds(0.15)), Seconds(0.004), Seconds(5), Seconds(100));
  EXPECT_LE(course.longest, CheckpointPace::kMaxWork + Seconds(0.005));
  EXPECT_GT(course.longest, CheckpointPace::kMaxWork - Seconds(0.005));
}

class BoundedLog : public testing::Test {
 protected:
  BoundedLog() : simulation(mixed_simulation()) {
    StoredSession session;
    session.name = "n";
    session.instruction_set = to_string(simulation.instruction_set());
    session.settings = "{}";
    number = storage.sessions().create(session, {1, 0, 0, 0, "scene.load", "{}", false});
  }
  static StorageSettings few_bytes() {
    StorageSettings limits;
    limits.log_bytes = 1000;
    return limits;
  }
  /// Appends commands of 100 bytes each.
  void append(SessionLog& log, int count) {
    for (int i = 0; i < count; ++i) {
      log.append({{log.last() + 1, 5, 5, 1, "world.set_gravity", std::string(100, ' '), false}},
                 [](auto failure) { EXPECT_FALSE(failure); });
      log.confirm(1);
    }
    storage.flush();
  }
  void keep(SessionLog& log, std::uint64_t loaded, bool always = true) {
    log.store({.position = 5,
               .tick = 5,
               .sequence = log.last(),
               .loaded = loaded,
               .participants = write_participants({}),
               .snapshot = simulation.snapshot()},
              clock.now(), always);
    storage.flush();
  }
  std::vector<std::uint64_t> sequences() {
    std::vector<std::uint64_t> all;
    for (const LogEntry& entry : storage.sessions().read(number, 0)) all.push_back(entry.sequence);
    return all;
  }

  const TemporaryFolder folder;
  ManualClock clock;
  Storage storage{folder.file("data"), few_bytes(), clock};
  const Simulation simulation;
  std::uint64_t number = 0;
};

// The budget of a minute is 9 MB by default. The clock stands still at first.
TEST_F(BoundedLog, CheckpointsStayWithinTheirBytesPerSecond) {
  SessionLog log(storage, number, {1, 0});
  const auto store = [&] {
    log.add_work(Seconds(5));
    EXPECT_TRUE(log.is_due(6, 1, clock.now()));
    keep(log, 1, false);
    return std::pair(storage.counts().checkpoints, storage.counts().recent_states);
  };
  using Counts = std::pair<std::uint64_t, std::uint64_t>;
  EXPECT_EQ(store(), Counts(1, 0));
  storage.count_checkpoint({}, 8'990'000);
  EXPECT_EQ(store(), Counts(3, 0)) << "the budget is used, and not exceeded";
  storage.count_checkpoint({}, 1'000'000);
  EXPECT_EQ(store(), Counts(4, 1));
  EXPECT_EQ(storage.recent_states().read(number).value().position, 5U);
  clock.advance(std::chrono::seconds(4));
  EXPECT_EQ(store(), Counts(4, 2));
  clock.advance(std::chrono::seconds(3));
  EXPECT_EQ(store(), Counts(5, 2));
}

/// A replica that stores nothing.
class NoReplica final : public SessionReplica {
  void append(const std::vector<LogEntry>&, Done done) override { done({}); }
  void refuse(std::uint64_t) override {}
  void reach(std::uint64_t, Done done) override { done({}); }
  void configure(const std::string&, const std::string&, Done done) override { done({}); }
  void write_progress(const SessionProgress&, Done) override {}
  std::uint64_t mark() const override { return 0; }
  void write_state(const Checkpoint&, const LogEntry&, std::uint64_t, bool) override {}
  void flush(Done done) override { done({}); }
  bool needs_state() const override { return false; }
  bool is_active() const override { return true; }
};

// The default of `checkpoint_after` is 2 s, and a quarter of it with a replica.
TEST_F(BoundedLog, TheWorkOfARecoveryCountsForTheNextCheckpoint) {
  const auto replica = std::make_shared<NoReplica>();
  std::uint64_t stored = 0;
  for (const auto& [work, has_replica, is_stored] :
       {std::tuple(1.9, false, false), {2.0, false, true}, {0.4, true, false}, {0.5, true, true}}) {
    SessionLog log(storage, number, {.last = 1, .work = Seconds(work)},
                   has_replica ? replica : nullptr);
    keep(log, 1, false);
    stored += is_stored ? 1 : 0;
    EXPECT_EQ(storage.counts().checkpoints, stored) << work;
  }
}

TEST_F(BoundedLog, BeyondItsLimitItBeginsAtTheCheckpointAndKeepsTheScene) {
  SessionLog log(storage, number, {1, 0});
  append(log, 9);
  keep(log, 1);
  EXPECT_EQ(sequences().size(), 10U) << "up to its limit nothing is forgotten";
  append(log, 3);
  EXPECT_EQ(sequences().size(), 13U) << "nor without a checkpoint";
  keep(log, 4);
  EXPECT_EQ(sequences(), std::vector<std::uint64_t>({4}));
  append(log, 2);
  EXPECT_EQ(sequences(), std::vector<std::uint64_t>({4, 14, 15}));
  ASSERT_FALSE(storage.checkpoints().places(number).empty());
  EXPECT_EQ(storage.checkpoints().places(number).back().sequence, 13U);
  keep(log, 4);  // the log is short again
  EXPECT_EQ(sequences().size(), 3U);
}

}  // namespace
}  // namespace vat::test::storage_checkpoint_test
