// Limits of recordings, logs and downloads.

#include "tests/server/replay/replay_fixture.h"

namespace vat::test::replay_limits_test {
namespace {

using namespace std::chrono_literals;

class LimitedRecordings : public ReplayTest {
 protected:
  LimitedRecordings()  // smaller than a state of the scene
      : ReplayTest(limits_with(&ServerLimits::max_recording_bytes, 1024)) {}
};

TEST_F(LimitedRecordings, AreRefusedBeyondTheirSize) {
  step(3);
  const Json data = client_->error("recording.export").at("data");
  EXPECT_EQ(data.at("kind"), "limit_reached");
  EXPECT_EQ(data.at("limit"), "recording_bytes");
  EXPECT_EQ(data.at("maximum"), 1024);
}

constexpr std::size_t kFewBytes = 45'000;

class LongRecordings : public ReplayTest {
 protected:
  LongRecordings()
      : ReplayTest(limits_with(&ServerLimits::max_recording_bytes, kFewBytes), rare_checkpoints()) {
  }
  static StorageSettings rare_checkpoints() {
    StorageSettings limits;
    limits.checkpoint_after = std::chrono::hours(1);
    return limits;
  }
};

TEST_F(LongRecordings, CountTheHashOfEachTick) {
  step(3);
  EXPECT_LT(client_->result("recording.export").at("bytes"), kFewBytes / 2);
  for (std::size_t ticks = 0; ticks * sizeof(RecordedHash) < kFewBytes; ticks += 500) step(500);
  EXPECT_EQ(client_->error("recording.export").at("data").at("limit"), "recording_bytes");
  const Json replayed = client_->error("replay.open", {{"session", "s1"}});
  EXPECT_EQ(replayed.at("data").at("limit"), "recording_bytes");
}

/// A session whose full log starts at a checkpoint, with or without commands after it.
class ShortenedLog : public ReplayTest, public testing::WithParamInterface<bool> {
 protected:
  ShortenedLog() : ReplayTest(unhurried_limits(), short_logs()) {}
  static StorageSettings short_logs() {
    StorageSettings limits;
    limits.log_bytes = GetParam() ? 12'000 : 1000;  // the scene takes 1500 bytes
    limits.checkpoint_after = std::chrono::milliseconds(1);
    return limits;
  }
};

TEST_P(ShortenedLog, IsReplayedFromItsFirstCheckpointOn) {
  Recording recording;
  for (int round = 0; round < 60; ++round) {
    for (int i = 0; i < 10; ++i) {
      client_->result("world.set_gravity", {{"gravity", {0.1 * i, 0, -9}}});
      step(1);
    }
    recording = record();
    if (!recording.is_whole() && (recording.log.size() > 1) == GetParam()) break;
  }
  ASSERT_FALSE(recording.is_whole());
  ASSERT_EQ(recording.log.size() > 1, GetParam());
  for (const RecordedMoment& moment : recording.moments) {
    EXPECT_GE(moment.sequence,
              GetParam() ? recording.log[1].sequence - 1 : recording.last_sequence());
  }
  ASSERT_FALSE(recording.moments.empty());
  EXPECT_EQ(recording.moments.front().position, recording.begin);
  step(5);
  recording = record();
  ReplayPlayer player(recording, environment_);
  SessionCore core("replay", {"replay"}, player.begin(), environment_);
  std::size_t compared = 0;
  player.on_same = [&](const RecordedHash&) { ++compared; };
  player.go_to_begin(core);
  player.play_to(core, recording.end, kGoOn);
  EXPECT_EQ(hash_of(core.run().simulation()), live_hash());
  EXPECT_EQ(compared, recording.hashes.size());
}

INSTANTIATE_TEST_SUITE_P(Logs, ShortenedLog, testing::Bool(), [](const auto& goes_on) {
  return goes_on.param ? "WithCommands" : "WithNone";
});

constexpr std::size_t kDownloadBytes = 200'000;

class LimitedDownloads : public ReplayTest {
 protected:
  LimitedDownloads() : ReplayTest(limits_with(&ServerLimits::max_download_bytes, kDownloadBytes)) {}
};

TEST_F(LimitedDownloads, WaitForTheFetchOfAnEarlierOne) {
  step(3);
  std::vector<Json> waiting;
  Json reply;
  std::size_t bytes = 0;
  while (waiting.size() < 200 && !(reply = client_->call("recording.export")).contains("error")) {
    waiting.push_back(reply.at("result"));
    bytes += waiting.back().at("bytes").get<std::size_t>();
  }
  ASSERT_TRUE(reply.contains("error"));
  EXPECT_EQ(reply.at("error").at("data").at("limit"), "download_bytes");
  EXPECT_LE(bytes, kDownloadBytes);
  ASSERT_FALSE(waiting.empty());
  // Each export adds a checkpoint, so the last download is the largest.
  const std::string path = waiting.back().at("path");
  EXPECT_TRUE(server_.downloads().take(path, server_.clock().now()).has_value());
  client_->result("recording.export");
}

TEST_F(ReplayTest, OldDownloadsEndWithoutNewOnes) {
  Downloads& downloads = server_.downloads();
  ASSERT_TRUE(downloads.add({"old", "content"}, server_.clock().now()));
  const auto held = [&] { return downloads.forget_old({}); };  // nothing has expired at that time
  server_.clock().advance(Downloads::kPatience - 1s);
  EXPECT_GT(held(), 0U);
  server_.clock().advance(1min);
  EXPECT_EQ(held(), 0U);
}

}  // namespace
}  // namespace vat::test::replay_limits_test
