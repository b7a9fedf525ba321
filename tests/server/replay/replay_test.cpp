#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>

#include "server/http/downloads.h"
#include "server/replay/replay_player.h"
#include "server/session/core/scene_loading.h"
#include "tests/server/fixture/session_fixture.h"
#include "tests/support/lone_environment.h"
#include "tests/support/temporary_folder.h"

// What a session did is exported, and run again elsewhere.

namespace vat::test::replay_test {
namespace {

using namespace std::chrono_literals;

const std::atomic<bool> kGoOn = false;

/// A server that keeps its sessions, with one of them, and what such a session needs elsewhere.
class ReplayTest : public testing::Test {
 protected:
  explicit ReplayTest(const ServerLimits& limits = {}, const StorageLimits& storage = {})
      : catalogue_(make_catalogue()), server_(catalogue_, settings(limits, storage)) {
    EXPECT_TRUE(server_.create_session("first", to_scene(mixed_scene_text())).ok());
    client_.emplace(server_, 1);
    client_->result("session.join");
    client_->result("control.pause");
    client_->result("control.reset");
    elsewhere_.limits.max_particles = elsewhere_.limits.max_particle_steps_per_tick = 1'000'000'000;
  }
  void TearDown() override { client_->disconnect(); }

  /// All kinds of entries, with ticks between them.
  void live() {
    step(5);
    client_->result("world.set_gravity", {{"gravity", {1, 0, -5}}});
    const Json grab =
        client_->result("grab.start", {{"body", 2}, {"particle", 0}, {"target", {0.5, 0.5, 0.8}}});
    step(3);
    client_->result("grab.move", {{"grab", grab.at("grab")}, {"target", {0.4, 0.5, 0.9}}});
    step(4);
    client_->error("grab.start", {{"body", 77}, {"particle", 0}, {"target", {0, 0, 0}}});
    edit();
    remove_and_bring_back();
    client_->result("world.remove_body", {{"body", 4}});
    add("new", 0.3);
    step(6);
    add("newer", 0.7);
    client_->result("control.reset");
    add("newest", 0.3);  // whose id tells of those before
    step(2);
    client_->result("world.apply_force", {{"body", 3}, {"force", {0, 0, 9}}, {"duration", 0.1}});
    TestClient other(server_, 2);
    other.result("session.join", {{"session", "s1"}});
    other.result("grab.start", {{"body", 3}, {"particle", 0}, {"target", {0.5, 0.5, 1}}});
    step(3);
    other.result("session.leave");
    step(7);
  }
  /// The ball comes back as body 4, in the motion that it had.
  void remove_and_bring_back() {
    const Json ball = client_->result("state.query", {{"bodies", {"ball"}}}).at("bodies").at(0);
    Json motion;
    for (const char* member : {"center_of_mass", "orientation", "velocity", "angular_velocity"}) {
      motion[member] = ball.at(member);
    }
    const Json body = client_->result("scene.get").at("scene").at("bodies").at(2);
    client_->result("world.remove_body", {{"body", 3}});
    client_->result("world.add_body", {{"body", body}, {"state", motion}});
  }
  /// What a scene's editor does.
  void edit() {
    Json material = client_->result("scene.get").at("scene").at("materials").at(0);
    material["density"] = 800;
    client_->result("world.set_material", {{"material", material}});
    client_->result("world.move_vat", {{"offset", {0.2, -0.1, 0}}});
    step(2);
    client_->result("world.move_body",
                    {{"body", 2}, {"position", {0.5, 0.5, 0.8}}, {"velocity", {0.1, 0, -1}}});
    step(2);
    client_->result("world.move_vat", {{"offset", {0, 0, 0}}});
    client_->error("world.move_body", {{"body", 2}, {"position", {5, 0, 0}}});
    client_->result("world.set_numerics", {{"integrator", "heun"}, {"step", 0.001}});
    client_->error("world.set_numerics", {{"step", 0.003}});
  }
  static constexpr std::uint64_t kGrown = 5 + 3 + 4 + 2 + 2 + 6;  // two were added, one removed
  static constexpr std::uint64_t kTicks = kGrown + 2 + 3 + 7;

  void add(const std::string& name, double x) {
    client_->result("world.add_body", {{"body",
                                        {{"name", name},
                                         {"kind", "rigid"},
                                         {"material", "wood"},
                                         {"spacing", 0.1},
                                         {"position", {x, 0.7, 0.85}},
                                         {"shape", {{"type", "sphere"}, {"radius", 0.1}}}}}});
  }
  void step(int ticks) { client_->result("control.step", {{"ticks", ticks}}); }
  std::string live_hash() { return client_->result("session.hash").at("hash"); }

  Recording record() {
    const Json exported = client_->result("recording.export");
    const std::string path = exported.at("path");
    auto file = server_.downloads().take(path, server_.clock().now());
    EXPECT_TRUE(file.has_value());
    EXPECT_FALSE(server_.downloads().take(path, server_.clock().now()).has_value());
    EXPECT_EQ(exported.at("bytes"), file->content.size());
    EXPECT_EQ(file->name, "s1.vatrec");
    const std::string& bytes = file->content;
    Result<Recording> recording =
        read_recording({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    EXPECT_TRUE(recording.ok());
    return std::move(recording).value();
  }

  /// A recording at play.
  struct Replay {
    Replay(const Recording& recording, const SessionEnvironment& environment)
        : player(recording, environment), core("replay", {"replay"}, player.begin(), environment) {
      player.on_same = [this](const RecordedHash&) { ++compared; };
      player.compare_moments();
      player.go_to_begin(core);
    }
    std::string hash() const { return hash_of(core.run().simulation()); }
    ReplayPlayer player;
    SessionCore core;
    std::size_t compared = 0;
  };

 private:
  ServerSettings settings(const ServerLimits& limits, const StorageLimits& storage) const {
    ServerSettings settings = test_settings(limits, folder_.file("data"));
    settings.storage = storage;
    return settings;
  }

 protected:
  const TemporaryFolder folder_;
  const Catalogue catalogue_;
  TestServer server_;
  std::optional<TestClient> client_;
  LoneEnvironment elsewhere_{catalogue_, 2};
  const SessionEnvironment& environment_ = elsewhere_.shared;
};

TEST_F(ReplayTest, EndsInTheStateOfTheSession) {
  live();
  const Recording recording = record();
  Replay replay(recording, environment_);
  replay.player.play_to(replay.core, recording.end, kGoOn);
  EXPECT_EQ(replay.hash(), live_hash());
  EXPECT_GE(recording.end, kTicks);
  EXPECT_GT(replay.compared, 0U);
}

/// With the moments of the recording, and with those that it keeps as it plays alone.
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

TEST_F(ReplayTest, PassesOverAHashOfAPlaceThatThereIsNot) {
  live();
  Recording recording = record();
  const auto second =
      std::ranges::find(recording.hashes, recording.begin + 2, &RecordedHash::position);
  ASSERT_NE(second, recording.hashes.end());
  recording.hashes.insert(second, {second->position, second->sequence - 1, 1});
  Replay replay(recording, environment_);
  replay.player.play_to(replay.core, recording.end, kGoOn);
  EXPECT_EQ(replay.hash(), live_hash());
}

TEST_F(ReplayTest, HasAHashOfEveryTick) {
  live();
  const Recording recording = record();
  for (std::uint64_t at = recording.begin + 1; at <= recording.end; ++at) {
    EXPECT_TRUE(std::ranges::count(recording.hashes, at, &RecordedHash::position) > 0) << at;
  }
}

TEST_F(ReplayTest, TellsTheFirstTickThatDiffers) {
  live();
  Recording recording = record();
  const auto gravity = std::ranges::find(recording.log, "world.set_gravity", &LogEntry::method);
  ASSERT_NE(gravity, recording.log.end());
  gravity->params = R"({"gravity":[1,0,-5.000001]})";
  recording.moments.clear();
  Replay replay(recording, environment_);
  try {
    replay.player.play_to(replay.core, recording.end, kGoOn);
    ADD_FAILURE() << "nothing was noticed";
  } catch (const Diverged& difference) {
    EXPECT_EQ(replay.core.run().position(), gravity->position + 1);
    EXPECT_NE(std::string(difference.what()).find("at tick 6 "), std::string::npos)
        << difference.what();
    EXPECT_NE(std::string(difference.what()).find("the same up to tick 5"), std::string::npos);
  }
}

/// Why going to a position fails.
std::string fault_of_seek(ReplayPlayer& player, SessionCore& core, std::uint64_t position) {
  try {
    player.begin_seek(core, position);
    return "";
  } catch (const StorageError& error) {
    return error.what();
  }
}

TEST_F(ReplayTest, RefusesAMomentThatTellsOfAnotherPlace) {
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
    EXPECT_THAT(fault_of_seek(player, core, other.end), testing::HasSubstr("another place"))
        << field;
  }
}

/// What a session had more of later than its scene has counts where a replay goes there.
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

TEST_F(ReplayTest, TellsNothingThatLetsAnybodyIn) {
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

class LimitedRecordings : public ReplayTest {
 protected:
  LimitedRecordings()  // a state of the scene has more
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
  static StorageLimits rare_checkpoints() {
    StorageLimits limits;
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

/// A session whose log is full, and begins at a checkpoint: with commands behind that, or with
/// none.
class ShortenedLog : public ReplayTest, public testing::WithParamInterface<bool> {
 protected:
  ShortenedLog() : ReplayTest(unhurried_limits(), short_logs()) {}
  static StorageLimits short_logs() {
    StorageLimits limits;
    limits.log_bytes = GetParam() ? 12'000 : 1000;  // the scene takes 1500
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

TEST_F(LimitedDownloads, WaitUntilSomebodyFetchesWhatIsThere) {
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
  const std::string path = waiting.front().at("path");
  EXPECT_TRUE(server_.downloads().take(path, server_.clock().now()).has_value());
  client_->result("recording.export");
}

TEST_F(ReplayTest, OldDownloadsGoThoughNobodyAsksForAnother) {
  Downloads& downloads = server_.downloads();
  ASSERT_TRUE(downloads.add({"old", "content"}, server_.clock().now()));
  const auto held = [&] { return downloads.forget_old({}); };  // at that time nothing has expired
  server_.clock().advance(Downloads::kPatience - 1s);
  EXPECT_GT(held(), 0U);
  server_.clock().advance(1min);
  EXPECT_EQ(held(), 0U);
}

}  // namespace
}  // namespace vat::test::replay_test
