// The number of ticks that a seek in a recording repeats.

#include <set>

#include "server/history/recorder.h"
#include "server/history/session_log.h"
#include "server/replay/moment_filler.h"
#include "server/replay/replay_player.h"
#include "tests/server/fixture/session_fixture.h"
#include "tests/support/lone_environment.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace vat::test::replay_seek_test {
namespace {

const std::atomic<bool> kGoOn = false;
constexpr std::uint64_t kTicks = 300;
constexpr double kTickWork = 0.1;  // [s] reported work of each tick
constexpr std::chrono::seconds kWanted{1};
// The maximum work between two checkpoints, and the tick that exceeds it.
constexpr auto kMaxTicks = static_cast<std::uint64_t>(1 / kTickWork) + 1;

StorageSettings limits_with(std::size_t checkpoint_bytes) {
  StorageSettings limits;
  limits.checkpoint_after = kWanted;
  limits.checkpoint_bytes = checkpoint_bytes;
  return limits;
}

/// A stored session that has run for kTicks. Its time consists only of the reported work of ticks.
class KeptSession {
 public:
  /// `commands`: the ticks that a command precedes.
  explicit KeptSession(std::size_t checkpoint_bytes, const std::set<std::uint64_t>& commands = {})
      : storage_(folder_.file("data"), limits_with(checkpoint_bytes), environment_.clock) {
    const Scene scene = to_scene(mixed_scene_text());
    StoredSession session;
    session.name = "n";
    session.instruction_set = to_string(best_instruction_set());
    session.settings = "{}";
    number_ = storage_.sessions().create(
        session, {1, 0, 0, 0, "scene.load", Json{{"scene", write_scene(scene)}}.dump(), false});
    SessionCore core("s1", {"n"}, Simulation::create(scene).value(), environment());
    core.history().keep_in(
        std::make_unique<SessionLog>(storage_, number_, SessionLog::Place{1, 0}));
    for (std::uint64_t tick = 0; tick < kTicks; ++tick) {
      if (commands.contains(tick)) command(core);
      run_tick(core);
    }
    core.history().log()->store(core.history().moment(), environment_.clock.now());
    storage_.flush();
  }
  Recording record() { return record_session(storage_, number_, kMaxRecordingBytes).value(); }
  /// Deletes commands up to a sequence, except the first, which contains the scene.
  void shorten(std::uint64_t last) { storage_.sessions().trim(number_, last, 1); }
  const SessionEnvironment& environment() const { return environment_.shared; }

 private:
  static void command(SessionCore& core) {
    LogEntry entry{0, core.run().position(), core.run().tick(), 1, "leave", "{}", false};
    SessionLog& log = *core.history().log();
    log.number({&entry, 1});
    log.append({entry}, [](auto failure) { EXPECT_FALSE(failure); });
    log.confirm(1);
    core.execute(entry, [](SessionCore&, Participant&) -> ActionResult { return Json::object(); });
  }
  void run_tick(SessionCore& core) {
    ASSERT_TRUE(core.tick(environment_.clock.now(), false));
    SessionLog& log = *core.history().log();
    log.add_hash(core.run().position(), core.run().simulation().state_hash());
    log.add_work(CheckpointPace::Seconds(kTickWork));
    if (log.is_due(core.run().position(), 0, environment_.clock.now())) {
      log.store(core.history().moment(), environment_.clock.now());
      storage_.flush();
    }
  }

  const TemporaryFolder folder_;
  const LoneEnvironment environment_;
  Storage storage_;
  std::uint64_t number_ = 0;
};

/// Returns the largest number of ticks of a seek, over all positions. Each seek starts at the end.
std::uint64_t most_ticks(const Recording& recording, ReplayPlayer& player, SessionCore& core) {
  std::uint64_t most = 0;
  for (std::uint64_t at = recording.begin; at <= recording.end; ++at) {
    player.begin_seek(core, recording.end);
    player.begin_seek(core, at);
    most = std::max(most, at - core.run().position());
  }
  return most;
}

TEST(ReplaySeeks, RunNoMoreTicksThanLieBetweenTwoCheckpoints) {
  KeptSession session(std::size_t{64} << 20);
  const Recording recording = session.record();
  ASSERT_EQ(recording.end, kTicks);
  ReplayPlayer player(recording, session.environment());
  SessionCore core("replay", {"n"}, player.begin(), session.environment());
  EXPECT_LE(most_ticks(recording, player, core), kMaxTicks);
}

TEST(ShortenedRecording, HasItsHashesAtTheirPositions) {
  KeptSession session(std::size_t{64} << 20, {50, 200});
  session.shorten(2);
  const Recording recording = session.record();
  ASSERT_EQ(recording.log.size(), 2U);
  ASSERT_FALSE(recording.is_whole());
  EXPECT_EQ(recording.moments.front().sequence, 2U);
  EXPECT_GT(recording.hashes.size(), 200U);
  for (const RecordedHash& hash : recording.hashes) {
    EXPECT_EQ(hash.sequence, hash.position <= 200 ? 2U : 3U) << hash.position;
  }
}

TEST(ReplaySeeks, ContinueFromTheCurrentPositionIfItIsNearer) {
  KeptSession session(std::size_t{64} << 20);
  Recording recording = session.record();
  recording.moments.clear();
  ReplayPlayer player(recording, session.environment());
  player.set_cache(
      {MomentCache::Seconds(1e9), 0});  // no cache, independently of the speed of the machine
  SessionCore core("replay", {"n"}, player.begin(), session.environment());
  player.go_to_begin(core);
  player.play_to(core, 50, kGoOn);
  player.begin_seek(core, 60);
  EXPECT_EQ(core.run().position(), 50U);
  player.begin_seek(core, 40);
  EXPECT_EQ(core.run().position(), recording.begin);
}

TEST(ReplaySeeks, RunAtMostTwoGapsAfterThinning) {
  const std::size_t bytes = [] {
    const Recording recording = KeptSession(std::size_t{64} << 20).record();
    std::size_t sum = 0;
    for (const RecordedMoment& moment : recording.moments) sum += moment.state.size();
    return sum;
  }();
  KeptSession session(bytes * 5 / 8);
  const Recording recording = session.record();
  ReplayPlayer player(recording, session.environment());
  SessionCore core("replay", {"n"}, player.begin(), session.environment());
  const std::uint64_t most = most_ticks(recording, player, core);
  EXPECT_GT(most, kMaxTicks);
  EXPECT_LE(most, 2 * kMaxTicks);
}

TEST(ReplaySeeks, RunNoTicksToFilledMoments) {
  KeptSession session(std::size_t{64} << 20);
  Recording recording = session.record();
  recording.moments.clear();
  ReplayPlayer player(recording, session.environment());
  player.set_cache({std::chrono::seconds(0), std::size_t{64} << 20});
  SessionCore core("replay", {"n"}, player.begin(), session.environment());
  player.go_to_begin(core);
  player.play_to(core, recording.end, kGoOn);
  EXPECT_EQ(most_ticks(recording, player, core), 0U);
}

constexpr std::size_t kMuch = std::size_t{64} << 20;

std::vector<RecordedMoment> moments_at(const Recording& recording,
                                       const SessionEnvironment& environment,
                                       std::uint64_t position) {
  const auto all = std::make_shared<MomentCache>(std::chrono::seconds(0), kMuch);
  ReplayPlayer player(recording, environment);
  player.share(all);
  SessionCore core("replay", {"n"}, player.begin(), environment);
  player.go_to_begin(core);
  player.play_to(core, position, kGoOn);
  return {*all->find(position)};
}

TEST(MomentFilling, BeginsWithTheWidestGap) {
  KeptSession session(kMuch);
  Recording recording = session.record();
  constexpr std::uint64_t kNarrow = 100;
  recording.moments.clear();
  recording.moments = moments_at(recording, session.environment(), kNarrow);
  const auto kept = std::make_shared<MomentCache>(std::chrono::seconds(0), kMuch);
  const MomentFiller filler(std::make_shared<const Recording>(recording), session.environment(),
                            kept);
  const auto begins_with_the_widest = [&] {
    const std::vector<std::uint64_t> there = kept->positions();
    const auto wide = std::ranges::count_if(there, [](auto at) { return at > kNarrow; });
    const bool has_narrow = static_cast<std::size_t>(wide) < there.size();
    return !has_narrow || static_cast<std::uint64_t>(wide) == kTicks - kNarrow;
  };
  ASSERT_TRUE(wait_until([&] { return filler.is_done() || !begins_with_the_widest(); }));
  EXPECT_TRUE(begins_with_the_widest());
  EXPECT_EQ(kept->count(), kTicks - 1);  // the recording contains one more
}

TEST(MomentFilling, EndsWithItsReplay) {
  KeptSession session(kMuch);
  Recording recording = session.record();
  recording.end += 100'000'000;
  const auto kept = std::make_shared<MomentCache>(std::chrono::hours(1), kMuch);
  const MomentFiller filler(std::make_shared<const Recording>(recording), session.environment(),
                            kept);
  EXPECT_FALSE(filler.is_done());
}

TEST(MomentCache, BeyondTheirBytesLieTwiceAsFarApart) {
  MomentCache kept(std::chrono::seconds(1), 1000);
  for (std::uint64_t at = 1; at <= 11; ++at) {
    EXPECT_EQ(kept.work().count(), 1) << at;
    kept.add({at, 1, "", std::vector<std::uint8_t>(100)});
  }
  EXPECT_EQ(kept.work().count(), 2);
  EXPECT_EQ(kept.positions(), (std::vector<std::uint64_t>{2, 4, 6, 8, 10}));
  EXPECT_EQ(kept.bytes(), 500U);
}

}  // namespace
}  // namespace vat::test::replay_seek_test
