#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "server/http/downloads.h"
#include "server/replay/replay_player.h"
#include "tests/server/session_fixture.h"
#include "tests/support/temporary_folder.h"

// What a session did is exported, and run again elsewhere.

namespace vat::test {
namespace {

const std::atomic<bool> kGoOn = false;

/// A server that keeps its sessions, with one of them, and what such a session needs elsewhere.
class ReplayTest : public testing::Test {
 protected:
  ReplayTest() : catalogue_(make_catalogue()), server_(catalogue_, settings()) {
    EXPECT_TRUE(server_.create_session("first", to_scene(mixed_scene_text())).ok());
    client_.emplace(server_, 1);
    client_->result("session.join");
    client_->result("control.pause");
    client_->result("control.reset");
    limits_.max_particles = limits_.max_particle_steps_per_tick = 1'000'000'000;
  }
  ~ReplayTest() override { client_->disconnect(); }

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
    client_->result("world.remove_body", {{"body", 3}});
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
  static constexpr std::uint64_t kTicks = 5 + 3 + 4 + 6 + 2 + 3 + 7;

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
    auto file = server_.downloads().take(path, Downloads::Clock::now());
    EXPECT_TRUE(file.has_value());
    EXPECT_FALSE(server_.downloads().take(path, Downloads::Clock::now()).has_value());
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
  ServerSettings settings() const {
    ServerSettings settings;
    settings.threads = 2;
    settings.data_folder = folder_.file("data");
    return settings;
  }

 protected:
  const TemporaryFolder folder_;
  const Catalogue catalogue_;
  SessionServer server_;
  std::optional<TestClient> client_;
  ServerLimits limits_;
  ThreadPoolRunner runner_{2};
  ServerMetrics metrics_;
  ResourceBudget resources_{kUnlimitedResources};
  boost::asio::thread_pool frame_threads_{1};
  AccessTokens tokens_{1};
  const SessionEnvironment environment_{catalogue_, limits_,    best_instruction_set(), runner_,
                                        metrics_,   resources_, frame_threads_,         tokens_};
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
  if (GetParam()) seeking.player.set_keeping({std::chrono::seconds(0), 1 << 20});
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

TEST_F(ReplayTest, KeepsMomentsWithinItsMemory) {
  live();
  const Recording recording = record();
  Replay replay(recording, environment_);
  constexpr std::size_t kBytes = 40'000;
  replay.player.set_keeping({std::chrono::seconds(0), kBytes});
  replay.player.play_to(replay.core, recording.end, kGoOn);
  EXPECT_GT(replay.player.kept_moments(), 0U);
  EXPECT_LE(replay.player.kept_bytes(), kBytes);
}

TEST_F(ReplayTest, SaysWhereItLeadsElsewhere) {
  live();
  Recording recording = record();
  const auto gravity = std::ranges::find(recording.log, "world.set_gravity", &LogEntry::method);
  ASSERT_NE(gravity, recording.log.end());
  const std::uint64_t at = gravity->position + 3;
  Replay before(recording, environment_);
  std::vector<RecordedHash> hashes;
  for (const std::uint64_t position : {at - 1, at}) {
    before.player.play_to(before.core, position, kGoOn);
    hashes.push_back(
        {position, before.core.sequence(), before.core.run().simulation().state_hash()});
  }
  recording.hashes = hashes;
  recording.moments.clear();
  Replay same(recording, environment_);
  same.player.play_to(same.core, recording.end, kGoOn);
  gravity->params = R"({"gravity":[1,0,-5.000001]})";
  Replay replay(recording, environment_);
  try {
    replay.player.play_to(replay.core, recording.end, kGoOn);
    ADD_FAILURE() << "nothing was noticed";
  } catch (const Diverged& difference) {
    EXPECT_NE(std::string(difference.what()).find("at tick 7 "), std::string::npos)
        << difference.what();
  }
}

TEST_F(ReplayTest, TellsNothingThatLetsAnybodyIn) {
  const std::string token = client_->result("session.join").at("resume");
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

TEST(Downloads, AreFetchedOnceAndInTime) {
  Downloads downloads;
  const Downloads::Clock::time_point now{};
  const std::string first = downloads.add({"a", "one"}, now).value();
  const std::string second = downloads.add({"b", "two"}, now).value();
  EXPECT_NE(first, second);
  EXPECT_FALSE(downloads.take("/downloads/", now).has_value());
  EXPECT_EQ(downloads.take(first, now)->content, "one");
  EXPECT_FALSE(downloads.take(first, now).has_value());
  EXPECT_FALSE(downloads.take(second, now + Downloads::kPatience).has_value());
}

TEST(Downloads, AreServedByTheSite) {
  Downloads downloads;
  const HttpHandler site = with_downloads(
      [](std::string_view, std::string_view) {
        return HttpResponse{404, "", "", {}};
      },
      downloads);
  const std::string path = downloads.add({"a.vatrec", "one"}, Downloads::Clock::now()).value();
  EXPECT_EQ(site("POST", path).status, 404);
  EXPECT_EQ(site("HEAD", path).status, 404);
  const HttpResponse response = site("GET", path);
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.body, "one");
  EXPECT_EQ(site("GET", path).status, 404);
}

}  // namespace
}  // namespace vat::test
