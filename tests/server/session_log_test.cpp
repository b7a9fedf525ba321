// When checkpoints are written, and what of a log is forgotten.

#include "server/session/session_log.h"

#include <gtest/gtest.h>

#include "tests/server/session_fixture.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::session_log_test {
namespace {

using Seconds = CheckpointPace::Seconds;

struct Course {
  double share = 0;  ///< of checkpoints in all work
  Seconds longest{0};
};

/// A session that works in ticks of `tick` for so long, and whose checkpoints cost so much.
Course follow(CheckpointPace pace, Seconds tick, Seconds cost, Seconds length) {
  Course course;
  Seconds since{0};
  Seconds spent{0};
  for (Seconds work{0}; work < length; work += tick) {
    pace.add_work(tick);
    since += tick;
    course.longest = std::max(course.longest, since);
    if (!pace.is_due(cost)) continue;
    pace.begin();
    spent += cost;
    since = Seconds(0);
  }
  course.share = spent / length;
  return course;
}

TEST(CheckpointPace, CheapOnesComeAsOftenAsIsWanted) {
  const Course course =
      follow(CheckpointPace(Seconds(0.15)), Seconds(0.004), Seconds(0.001), Seconds(100));
  EXPECT_LE(course.longest.count(), 0.15 + 0.004);
  EXPECT_LE(course.share, CheckpointPace::kGreatestShare);
}

TEST(CheckpointPace, DearOnesTakeTheirShareAndNoMore) {
  for (const double cost : {0.01, 0.02, 0.05, 0.1}) {
    const Course course =
        follow(CheckpointPace(Seconds(0.15)), Seconds(0.004), Seconds(cost), Seconds(1000));
    // Sums of a million roundings.
    EXPECT_LE(course.share, CheckpointPace::kGreatestShare * (1 + 1e-9)) << cost;
    // And no less than one tick in the time between two of them.
    EXPECT_GE(course.share, CheckpointPace::kGreatestShare * 0.97 - cost / 1000) << cost;
  }
}

TEST(CheckpointPace, SomeComeWhateverTheyCost) {
  const Course course =
      follow(CheckpointPace(Seconds(0.15)), Seconds(0.004), Seconds(5), Seconds(100));
  EXPECT_LE(course.longest, CheckpointPace::kMostWork + Seconds(0.005));
  EXPECT_GT(course.longest, CheckpointPace::kMostWork - Seconds(0.005));
}

class BoundedLog : public testing::Test {
 protected:
  BoundedLog() : simulation(Simulation::create(to_scene(mixed_scene_text())).value()) {
    StoredSession session;
    session.name = "n";
    session.instruction_set = to_string(simulation.instruction_set());
    session.settings = "{}";
    number = storage.sessions().create(session, {1, 0, 0, 0, "scene.load", "{}", false});
  }
  static StorageLimits few_bytes() {
    StorageLimits limits;
    limits.log_bytes = 1000;
    return limits;
  }
  /// Commands of 100 bytes each.
  void append(SessionLog& log, int count) {
    for (int i = 0; i < count; ++i) {
      LogEntry entry{0, 5, 5, 1, "world.set_gravity", std::string(100, ' '), false};
      log.append({&entry, 1});
    }
  }
  void keep(SessionLog& log, std::uint64_t loaded) {
    log.keep({.position = 5,
              .tick = 5,
              .sequence = log.last(),
              .loaded = loaded,
              .participants = write_participants({}),
              .snapshot = simulation.snapshot()},
             SteadyClock::now(), true);
    storage.flush();
  }
  std::vector<std::uint64_t> sequences() {
    std::vector<std::uint64_t> all;
    for (const LogEntry& entry : storage.sessions().read(number, 0)) all.push_back(entry.sequence);
    return all;
  }

  const TemporaryFolder folder;
  Storage storage{folder.file("data"), few_bytes()};
  const Simulation simulation;
  std::uint64_t number = 0;
};

TEST_F(BoundedLog, UpToItsLimitNothingIsForgotten) {
  SessionLog log(storage, number, {1, 0});
  append(log, 9);
  keep(log, 1);
  EXPECT_EQ(sequences().size(), 10U);
}

TEST_F(BoundedLog, BeyondItsLimitItBeginsAtTheCheckpointAndKeepsTheScene) {
  SessionLog log(storage, number, {1, 0});
  append(log, 12);
  keep(log, 4);
  EXPECT_EQ(sequences(), std::vector<std::uint64_t>({4}));
  append(log, 2);
  EXPECT_EQ(sequences(), std::vector<std::uint64_t>({4, 14, 15}));
  ASSERT_FALSE(storage.checkpoints().places(number).empty());
  EXPECT_EQ(storage.checkpoints().places(number).back().sequence, 13U);
  keep(log, 4);  // it is small again
  EXPECT_EQ(sequences().size(), 3U);
}

TEST_F(BoundedLog, WithoutACheckpointNothingIsForgotten) {
  SessionLog log(storage, number, {1, 0});
  append(log, 30);
  EXPECT_EQ(sequences().size(), 31U);
}

}  // namespace
}  // namespace vat::test::session_log_test
