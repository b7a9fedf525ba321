#include <gmock/gmock.h>

#include <sstream>

#include "server/operations/server_metrics.h"
#include "tests/server/fixture/session_fixture.h"

namespace vat::test::server_metrics_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

ServerMetrics::Gauges make_present() {
  ServerMetrics::Gauges present;
  present.version = "1.2.3";
  present.instructions = InstructionSet::avx2;
  present.threads = 4;
  present.playing_sessions = 2;
  present.paused_sessions = 1;
  present.connections = 7;
  present.clients = 5;
  present.particles = 1200;
  present.memory = {50'000'000, 80'000'000, 9'000'000, {{"queues", 1000}, {"imports", 0}}};
  return present;
}

TEST(ServerMetrics, CurrentValues) {
  const std::string text = ServerMetrics().to_text(make_present());
  EXPECT_THAT(text, testing::StartsWith(
                        "# HELP vat_build_info Version, and instruction set of all sessions.\n"
                        "# TYPE vat_build_info gauge\n"
                        "vat_build_info{version=\"1.2.3\",instruction_set=\"avx2\"} 1\n"));
  for (const char* sample :
       {"\nvat_threads 4\n", "\nvat_sessions{state=\"playing\"} 2\n",
        "\nvat_sessions{state=\"paused\"} 1\n", "\nvat_connections 7\n", "\nvat_clients 5\n",
        "\nvat_particles 1200\n", "\nvat_heap_bytes 9000000\n",
        "\nvat_process_memory_bytes 50000000\n", "\nvat_max_memory_bytes 80000000\n",
        "\nvat_memory_bytes{use=\"queues\"} 1000\nvat_memory_bytes{use=\"imports\"} 0\n"}) {
    EXPECT_THAT(text, HasSubstr(sample));
  }
}

// A bucket counts all values up to its bound, so it includes the smaller buckets.
TEST(ServerMetrics, TicksAreCountedByTheirBounds) {
  ServerMetrics metrics;
  for (const auto time : {0.5ms, 0.6ms, 3.0ms, 5000.0ms}) {
    metrics.add_tick({time, 10, 2, {}});
  }
  EXPECT_THAT(metrics.to_text({}), HasSubstr("# TYPE vat_tick_duration_seconds histogram\n"
                                             "vat_tick_duration_seconds_bucket{le=\"0.0005\"} 1\n"
                                             "vat_tick_duration_seconds_bucket{le=\"0.001\"} 2\n"
                                             "vat_tick_duration_seconds_bucket{le=\"0.002\"} 2\n"
                                             "vat_tick_duration_seconds_bucket{le=\"0.005\"} 3\n"));
  EXPECT_THAT(metrics.to_text({}), HasSubstr("vat_tick_duration_seconds_bucket{le=\"2\"} 3\n"
                                             "vat_tick_duration_seconds_bucket{le=\"+Inf\"} 4\n"
                                             "vat_tick_duration_seconds_sum 5.0041\n"
                                             "vat_tick_duration_seconds_count 4\n"));
  EXPECT_THAT(metrics.to_text({}), HasSubstr("\nvat_substeps_total 40\n"));
  EXPECT_THAT(metrics.to_text({}), HasSubstr("\nvat_undone_substeps_total 8\n"));
}

// The last 512 of 1000 ticks take 489 to 1000 ms.
TEST(ServerMetrics, QuantilesAreThoseOfTheLastTicks) {
  ServerMetrics metrics;
  EXPECT_THAT(metrics.to_text({}), HasSubstr("\nvat_recent_tick_seconds{quantile=\"0.5\"} 0\n"));
  for (int i = 1; i <= 1000; ++i) {
    metrics.add_tick({i * 1ms, 1, 0, {}});
    metrics.add_lateness(i * 2ms);
  }
  const std::string text = metrics.to_text({});
  EXPECT_THAT(text, HasSubstr("# TYPE vat_recent_tick_seconds gauge\n"
                              "vat_recent_tick_seconds{quantile=\"0.5\"} 0.744\n"
                              "vat_recent_tick_seconds{quantile=\"0.99\"} 0.994\n"));
  EXPECT_THAT(text, HasSubstr("\nvat_recent_tick_lateness_seconds{quantile=\"0.99\"} 1.988\n"));
}

TEST(ServerMetrics, StagesOfOneNameAreOne) {
  ServerMetrics metrics;
  const std::vector<StageClock::Stage> first = {{"walls", 3, 250ms}, {"kick", 6, 125ms}};
  const std::vector<StageClock::Stage> second = {{"kick", 1, 125ms}};
  metrics.add_tick({1ms, 3, 0, first});
  metrics.add_tick({1ms, 1, 0, second});
  const std::string text = metrics.to_text({});
  EXPECT_THAT(text, HasSubstr("# TYPE vat_stage_seconds_total counter\n"
                              "vat_stage_seconds_total{stage=\"kick\"} 0.25\n"
                              "vat_stage_seconds_total{stage=\"walls\"} 0.25\n"));
  EXPECT_THAT(text, HasSubstr("# TYPE vat_stage_calls_total counter\n"
                              "vat_stage_calls_total{stage=\"kick\"} 7\n"
                              "vat_stage_calls_total{stage=\"walls\"} 3\n"));
}

TEST(ServerMetrics, FramesByOutcome) {
  ServerMetrics metrics;
  metrics.add_encoded_frame(250ms, true);
  metrics.add_encoded_frame(125ms, false);
  metrics.add_frame_groups(2);
  metrics.add_frame_groups(0);
  metrics.add_sent_frames(3, 1000);
  metrics.add_sent_frames(1, 50);
  metrics.add_missed_frames(4);
  const std::string text = metrics.to_text({});
  for (const char* sample :
       {"\nvat_states_shown_total 2\n", "\nvat_frame_groups_total 2\n",
        "\nvat_frames_encoded_total 2\n", "\nvat_key_frames_encoded_total 1\n",
        "\nvat_frame_encode_seconds_total 0.375\n", "\nvat_frames_sent_total 4\n",
        "\nvat_frame_bytes_sent_total 3050\n", "\nvat_frames_missed_total 4\n"}) {
    EXPECT_THAT(text, HasSubstr(sample));
  }
}

// session.stats, and the metrics of sessions.

constexpr int kStepsPerTick = 10;  // of the fixture's scene

class SessionStats : public SessionTest {
 protected:
  const std::size_t particles = mixed_simulation().particle_count();

  /// Returns the value of the sample with this name.
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

TEST_F(SessionStats, HaveTheCostOfTicks) {
  client->result("control.step", {{"ticks", 3}});
  client->result("scene.load", {{"scene", "mixed"}});
  EXPECT_EQ(client->result("session.stats").at("ticks"), 0) << "a new scene resets the statistics";
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
  client->result("control.reset");
  EXPECT_EQ(client->result("session.stats").at("ticks"), 5) << "a reset changes nothing";
}

TEST_F(SessionStats, CountSleepingBodies) {
  Json scene = Json::parse(R"({"format": "vat.scene/1", "gravity": [0, 0, 0],
      "sleeping": {"after": 0.1}, "materials": [{"name": "wood"}],
      "bodies": [{"name": "block", "kind": "rigid", "material": "wood", "spacing": 0.1,
                  "shape": {"type": "box", "size": [0.2, 0.2, 0.2]}}]})");
  client->result("scene.load", {{"scene", scene}});
  EXPECT_EQ(client->result("session.stats").at("sleeping_bodies"), 0);
  client->result("control.step", {{"ticks", 20}});
  EXPECT_EQ(client->result("session.stats").at("sleeping_bodies"), 1);
}

TEST_F(SessionStats, MetricsAreThoseOfAllSessions) {
  const auto guest = connect();
  guest->create_session();
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
}  // namespace vat::test::server_metrics_test
