// Playback of exported recordings.

#include <gmock/gmock.h>

#include "server/replay/log_replay.h"
#include "tests/server/replay/replay_fixture.h"

namespace vat::test::replay_test {
namespace {

/// Seeks with the moments of the recording, and with those that the player stores itself.
class SeekTest : public ReplayTest, public testing::WithParamInterface<bool> {};

TEST_P(SeekTest, LeadsToTheSameStatesFromAnywhere) {
  live();
  Recording recording = record();
  if (GetParam()) recording.moments.clear();
  Replay straight(recording, environment_);
  std::vector<std::string> hashes;
  for (std::uint64_t at = recording.begin; at <= recording.end; ++at) {
    straight.player.play_to(straight.core, at, kGoOn);
    hashes.push_back(straight.hash());
  }
  Replay seeking(recording, environment_);
  if (GetParam()) seeking.player.set_cache({std::chrono::seconds(0), 1 << 20});
  std::uint64_t at = recording.begin;
  for (int n = 0; n < 60; ++n) {
    at = recording.begin + (at * 7 + 5) % (recording.end - recording.begin + 1);
    seeking.player.seek(seeking.core, at, kGoOn);
    ASSERT_EQ(seeking.core.run().position(), at);
    ASSERT_EQ(seeking.hash(), hashes[at - recording.begin]) << at;
  }
}

INSTANTIATE_TEST_SUITE_P(Moments, SeekTest, testing::Bool(),
                         [](const auto& own) { return own.param ? "OfItsOwn" : "OfTheRecording"; });

TEST_F(ReplayTest, ComparesEveryTickAndPassesOverAHashOfAPlaceThatThereIsNot) {
  live();
  Recording recording = record();
  for (std::uint64_t at = recording.begin + 1; at <= recording.end; ++at) {
    EXPECT_TRUE(std::ranges::count(recording.hashes, at, &RecordedHash::position) > 0) << at;
  }
  const auto second =
      std::ranges::find(recording.hashes, recording.begin + 2, &RecordedHash::position);
  ASSERT_NE(second, recording.hashes.end());
  recording.hashes.insert(second, {second->position, second->sequence - 1, 1});
  Replay replay(recording, environment_);
  replay.player.play_to(replay.core, recording.end, kGoOn);
  EXPECT_EQ(replay.hash(), live_hash());
  EXPECT_GE(recording.end, kTicks);
  EXPECT_GT(replay.compared, 0U);
}

TEST_F(ReplayTest, ReportsTheFirstDifferentTick) {
  live();
  Recording recording = record();
  const auto gravity = std::ranges::find(recording.log, "world.set_gravity", &LogEntry::method);
  ASSERT_NE(gravity, recording.log.end());
  gravity->params = R"({"gravity":[1,0,-5.000001]})";
  recording.moments.clear();
  Replay replay(recording, environment_);
  try {
    replay.player.play_to(replay.core, recording.end, kGoOn);
    ADD_FAILURE() << "the difference was not detected";
  } catch (const Diverged& difference) {
    EXPECT_EQ(replay.core.run().position(), gravity->position + 1);
    EXPECT_NE(std::string(difference.what()).find("at tick 6 "), std::string::npos)
        << difference.what();
    EXPECT_NE(std::string(difference.what()).find("equal up to tick 5"), std::string::npos);
  }
}

/// Returns the error of a seek to a position.
std::string fault_of_seek(ReplayPlayer& player, SessionCore& core, std::uint64_t position) {
  try {
    player.begin_seek(core, position);
    return "";
  } catch (const StorageError& error) {
    return error.what();
  }
}

TEST_F(ReplayTest, RefusesAMomentOfAnotherPosition) {
  live();
  Recording recording = record();
  RecordedMoment& last = recording.moments.back();
  Replay good(recording, environment_);
  EXPECT_EQ(fault_of_seek(good.player, good.core, recording.end), "");
  for (const char* field : {"position", "sequence"}) {
    Json fields = Json::parse(last.fields);
    fields[field] = fields.at(field).get<std::uint64_t>() - 1;
    Recording other = recording;
    other.moments.back().fields = fields.dump();
    ReplayPlayer player(other, environment_);
    SessionCore core("replay", {"replay"}, player.begin(), environment_);
    player.go_to_begin(core);
    EXPECT_THAT(fault_of_seek(player, core, other.end), testing::HasSubstr("another position"))
        << field;
  }
}

/// The limits also apply to bodies that the session added after loading its scene.
TEST_F(ReplayTest, GoesToNoMomentBeyondTheLimits) {
  live();
  const Recording recording = record();
  const auto moments = std::make_shared<MomentCache>(std::chrono::seconds(0), 10'000'000);
  Replay straight(recording, environment_);
  straight.player.share(moments);
  straight.player.play_to(straight.core, recording.end, kGoOn);

  const Simulation scene = straight.player.begin();
  const std::size_t particles = resources_of(scene).particles;
  ResourceBudget few({particles, kUnlimitedResources.springs});
  const SessionEnvironment shared = elsewhere_.with(few);
  Recording without = recording;
  without.moments.clear();
  {
    ReplayPlayer player(without, shared);
    SessionCore core("replay", {"replay"}, player.begin(), shared);
    player.go_to_begin(core);
    player.share(moments);
    EXPECT_THAT(fault_of_seek(player, core, recording.begin + kGrown),
                testing::HasSubstr("particles"));
  }
  for (const bool is_small : {false, true}) {
    if (is_small) elsewhere_.limits.max_particles = particles;
    ReplayPlayer player(without, environment_);
    SessionCore core("replay", {"replay"}, player.begin(), environment_);
    player.go_to_begin(core);
    player.share(moments);
    const std::string fault = fault_of_seek(player, core, recording.begin + kGrown);
    EXPECT_EQ(fault.find("state: ") != std::string::npos, is_small) << fault;
  }
}

TEST_F(ReplayTest, ContainsNoTokens) {
  live();
  const Recording recording = record();
  ASSERT_FALSE(recording.moments.empty());
  for (const RecordedMoment& moment : recording.moments) {
    const Json fields = Json::parse(moment.fields);
    ASSERT_FALSE(fields.at("participants").at("list").empty());
    for (const Json& participant : fields.at("participants").at("list")) {
      EXPECT_EQ(participant.at("resume"), "");
    }
  }
}

}  // namespace
}  // namespace vat::test::replay_test
