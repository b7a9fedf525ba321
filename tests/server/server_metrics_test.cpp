#include "server/server_metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace vat::server_metrics_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

ServerMetrics::Present make_present() {
  ServerMetrics::Present present;
  present.version = "1.2.3";
  present.instructions = InstructionSet::avx2;
  present.threads = 4;
  present.playing_sessions = 2;
  present.paused_sessions = 1;
  present.connections = 7;
  present.clients = 5;
  present.particles = 1200;
  present.heap = 9'000'000;
  return present;
}

TEST(ServerMetrics, WhatIsSoNow) {
  const std::string text = ServerMetrics().to_text(make_present());
  EXPECT_THAT(text, testing::StartsWith(
                        "# HELP vat_build_info Version, and instruction set of all sessions.\n"
                        "# TYPE vat_build_info gauge\n"
                        "vat_build_info{version=\"1.2.3\",instruction_set=\"avx2\"} 1\n"));
  for (const char* sample :
       {"\nvat_threads 4\n", "\nvat_sessions{state=\"playing\"} 2\n",
        "\nvat_sessions{state=\"paused\"} 1\n", "\nvat_connections 7\n", "\nvat_clients 5\n",
        "\nvat_particles 1200\n", "\nvat_heap_bytes 9000000\n"}) {
    EXPECT_THAT(text, HasSubstr(sample));
  }
}

// A bucket counts what is at most its bound, so each holds those before it.
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

// Of 1000 ticks those of 489 to 1000 ms are the last 512.
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

TEST(ServerMetrics, FramesByWhatBecameOfThem) {
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

}  // namespace
}  // namespace vat::server_metrics_test
