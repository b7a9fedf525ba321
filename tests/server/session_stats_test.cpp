// session.stats, and what the server's metrics say of its sessions.

#include <gmock/gmock.h>

#include <sstream>

#include "tests/server/session_fixture.h"

namespace vat::test::session_stats_test {
namespace {

constexpr int kStepsPerTick = 10;  // of the fixture's scene

class SessionStats : public SessionTest {
 protected:
  const std::size_t particles =
      Simulation::create(to_scene(mixed_scene_text())).value().particle_count();

  /// The value of the sample that begins so.
  double sample(const std::string& name) {
    std::istringstream lines(server.metrics());
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with(name + ' ')) return std::stod(line.substr(name.size()));
    }
    ADD_FAILURE() << "no " << name;
    return 0;
  }
};

const Json* find_stage(const Json& stats, const std::string& name) {
  for (const Json& stage : stats.at("stages")) {
    if (stage.at("stage") == name) return &stage;
  }
  return nullptr;
}

TEST_F(SessionStats, TellWhatTheTicksOfTheSceneCost) {
  client->result("control.step", {{"ticks", 3}});
  client->result("scene.load", {{"scene", "mixed"}});
  EXPECT_EQ(client->result("session.stats").at("ticks"), 0) << "a new scene, a new account";
  client->result("control.step", {{"ticks", 5}});
  const Json stats = client->result("session.stats");
  EXPECT_EQ(stats.at("tick"), 5);
  EXPECT_EQ(stats.at("ticks"), 5);
  EXPECT_EQ(stats.at("substeps"), 5 * kStepsPerTick);
  EXPECT_EQ(stats.at("undone_substeps"), 0);
  EXPECT_EQ(stats.at("threads"), 2);
  EXPECT_EQ(stats.at("instruction_set"), to_string(best_instruction_set()));
  EXPECT_EQ(stats.at("particles"), particles);
  const double seconds = stats.at("seconds");
  EXPECT_GT(seconds, 0);
  EXPECT_LE(seconds / 5, stats.at("longest_tick"));
  for (const char* name : {"liquid_density", "contacts", "springs", "walls", "kick", "guard"}) {
    const Json* stage = find_stage(stats, name);
    ASSERT_NE(stage, nullptr) << name;
    EXPECT_GE(stage->at("calls"), kStepsPerTick) << name;
    EXPECT_GT(stage->at("seconds"), 0) << name;
  }
}

TEST_F(SessionStats, CountWhatSleeps) {
  Json scene = Json::parse(R"({"format": "vat.scene/1", "gravity": [0, 0, 0],
      "sleeping": {"after": 0.1}, "materials": [{"name": "wood"}],
      "bodies": [{"name": "block", "kind": "rigid", "material": "wood", "spacing": 0.1,
                  "shape": {"type": "box", "size": [0.2, 0.2, 0.2]}}]})");
  client->result("scene.load", {{"scene", scene}});
  EXPECT_EQ(client->result("session.stats").at("sleeping_bodies"), 0);
  client->result("control.step", {{"ticks", 20}});
  EXPECT_EQ(client->result("session.stats").at("sleeping_bodies"), 1);
}

TEST_F(SessionStats, StayThroughAReset) {
  client->result("control.step", {{"ticks", 2}});
  const Json before = client->result("session.stats").at("ticks");
  client->result("control.reset");
  EXPECT_EQ(client->result("session.stats").at("ticks"), before);
}

TEST_F(SessionStats, MetricsAreThoseOfAllSessions) {
  const auto guest = connect();
  guest->result("session.create", {{"name", "second"}, {"scene", "mixed"}});
  EXPECT_EQ(sample("vat_sessions{state=\"playing\"}"), 1);
  EXPECT_EQ(sample("vat_sessions{state=\"paused\"}"), 1);
  EXPECT_EQ(sample("vat_connections"), 2);
  EXPECT_EQ(sample("vat_clients"), 1);
  EXPECT_EQ(sample("vat_particles"), static_cast<double>(2 * particles));
  guest->result("session.join", {{"session", "s2"}});
  guest->result("control.pause");
  EXPECT_EQ(sample("vat_sessions{state=\"paused\"}"), 2);

  const double ticks = sample("vat_tick_duration_seconds_count");
  const double substeps = sample("vat_substeps_total");
  client->result("control.step", {{"ticks", 200}});
  guest->result("control.step", {{"ticks", 100}});
  EXPECT_EQ(sample("vat_tick_duration_seconds_count"), ticks + 300);
  EXPECT_EQ(sample("vat_substeps_total"), substeps + 300 * kStepsPerTick);
  EXPECT_GE(sample("vat_stage_calls_total{stage=\"springs\"}"), kStepsPerTick);
  EXPECT_GT(sample("vat_stage_seconds_total{stage=\"springs\"}"), 0);
}

}  // namespace
}  // namespace vat::test::session_stats_test
