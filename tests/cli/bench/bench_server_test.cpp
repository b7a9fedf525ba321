#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "protocol/frame/frame_codec.h"
#include "tests/bench/fanout/frame_facts.h"
#include "tests/bench/fanout/segments.h"
#include "tests/bench/faults/log_causes.h"
#include "tests/bench/report/quantile.h"
#include "tests/bench/soak/trend.h"
#include "tests/cli/program.h"
#include "tests/cli/readers.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::bench_server_test {
namespace {

using testing::HasSubstr;

std::string_view text_of(const std::vector<std::uint8_t>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Compares with the decoder, because the load parses the header independently.
TEST(BenchFanout, ReadsTheHeader) {
  GridFrame frame;
  frame.header.number = 77;
  frame.header.published = 1.7e9 + 0.25;
  frame.header.tick = 5;
  frame.scale.grid.quantum = 1;
  const bench::FrameFacts facts = bench::frame_facts(text_of(encode_key_frame(frame)));
  EXPECT_EQ(facts.number, 77U);
  EXPECT_TRUE(facts.is_key);
  EXPECT_EQ(facts.published, 1.7e9 + 0.25);
  EXPECT_THROW(bench::frame_facts("VATF"), std::runtime_error);
}

TEST(BenchReport, AQuantileIsTheValueOfTheNearestRank) {
  const std::vector<double> values{50, 10, 40, 20, 30};
  EXPECT_EQ(bench::quantile(values, 0), 10);
  EXPECT_EQ(bench::quantile(values, 0.37), 20);
  EXPECT_EQ(bench::quantile(values, 0.38), 30);
  EXPECT_EQ(bench::quantile(values, 1), 50);
  EXPECT_EQ(bench::median(std::vector<double>{4, 1}), 4);
  EXPECT_TRUE(std::isnan(bench::median(std::vector<double>{})));
}

// If all segments are equal, every bootstrap sample gives the same ratio. A different segment is
// missing in 0.9^10, a third, of the samples, so the interval contains both ratios.
TEST(BenchFanout, RatiosOfQuantilesHaveAnIntervalByWholeSegments) {
  const bench::Segments ones(10, {1, 2, 3, 4, 5});
  bench::Segments twos(10, {2, 4, 6, 8, 10});
  EXPECT_EQ(bench::pooled_quantile(ones, 0.5), 3);
  const bench::QuantileRatio alike = bench::quantile_ratio(ones, twos, 0.5);
  EXPECT_EQ(alike.value, 2);
  EXPECT_EQ(alike.low, 2);
  EXPECT_EQ(alike.high, 2);
  twos[3] = {100, 100, 100, 100, 100};
  const bench::QuantileRatio odd = bench::quantile_ratio(ones, twos, 0.99);
  EXPECT_EQ(odd.value, 100.0 / 5);
  EXPECT_EQ(odd.low, 2);
  EXPECT_EQ(odd.high, 20);
  EXPECT_TRUE(std::isnan(bench::quantile_ratio(bench::Segments(4, {1}), ones, 0.5).low));
}

// One viewer at the scene's rate. Other work on the machine can only reduce the rate.
TEST(BenchFanout, CountsTheFramesOfAViewer) {
  const Table table = bench_table("fanout", {"fanout", "--quick", "--case", "viewers-1"});
  ASSERT_EQ(table.rows.size(), 1U);
  const double rate = table.number(0, "frames per second");
  EXPECT_GT(rate, 0);
  EXPECT_LE(rate, 31) << "30 ticks per second, and one at the edge of each second";
  EXPECT_GT(table.number(0, "frame bytes"), 0);
  EXPECT_GT(table.number(0, "age 99 % [ms]"), 0);
}

TEST(BenchSeeks, GoesToMomentsOfARecording) {
  const Table table =
      bench_table("seeks", {"seeks", "--ticks", "150", "--seeks", "5", "--scene", "water-drop"});
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.number(0, "ticks"), 150);
  EXPECT_EQ(table.number(0, "seeks"), 5);
  EXPECT_GT(table.number(0, "checkpoints"), 0);
  EXPECT_GT(table.number(0, "median [ms]"), 0);
  EXPECT_LE(table.number(0, "median [ms]"), table.number(0, "99 % [ms]"));
  EXPECT_LE(table.number(0, "99 % [ms]"), table.number(0, "longest [ms]"));
  EXPECT_EQ(table.number(0, "within") == 5, table.number(0, "longest [ms]") <= 200);
}

TEST(BenchSeeks, ReportsARefusalOfTheServer) {
  const TemporaryFolder folder;
  EXPECT_THAT(run_bench({"seeks", "--scene", "gone", "--output", folder.path().string()}),
              exits(1, HasSubstr("gone")));
}

TEST(BenchDurability, MeasuresEachDurability) {
  const Table table =
      bench_table("durability", {"durability", "--sessions", "2", "--seconds", "1"});
  ASSERT_EQ(table.rows.size(), 3U);
  for (std::size_t row = 0; row < 3; ++row) {
    EXPECT_EQ(table.number(row, "commands"), 40);
    EXPECT_GT(table.number(row, "median reply [ms]"), 0);
    EXPECT_LE(table.number(row, "median reply [ms]"), table.number(row, "99 % reply [ms]"));
    EXPECT_LE(table.number(row, "median lateness [ms]"), table.number(row, "99 % lateness [ms]"));
  }
}

TEST(BenchRecovery, KillsAServerAndMeasuresItsRecovery) {
  const Table table = bench_table("recovery", {"recovery", "--particles", "400", "--kills", "1",
                                               "--warm-up", "0", "--seconds", "1"});
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.number(0, "kills"), 1);
  EXPECT_GT(table.number(0, "ticks per second"), 0);
  EXPECT_GT(table.number(0, "longest recovery [s]"), 0);
  EXPECT_LE(table.number(0, "median recovery [s]"), table.number(0, "longest recovery [s]"));
}

// A short version. The bounds of the tick rate and of the memory need the complete one.
TEST(BenchFaults, InjectsEachFaultAndLosesNothing) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_bench({"faults", "--seconds", "9", "--kill-every", "3", "--sessions", "3", "--clients",
                 "24", "--output", folder.path().string()});
  const Table table = read_csv((folder.path() / "faults.csv").string());
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::string measure = table.text(row, "measure");
    if (measure.find("tick rate") == std::string::npos &&
        measure.find("memory after") == std::string::npos) {
      EXPECT_EQ(table.text(row, "passed"), "true") << measure << '\n' << result.out << result.err;
    }
    if (measure == "kills") {
      EXPECT_GE(table.number(row, "value"), 2);
    }
  }
  EXPECT_GT(table.rows.size(), 10U) << result.out << result.err;
}

TEST(BenchFaults, ReportsLogLinesWithoutAKnownCause) {
  const bench::LoggedCauses causes = bench::find_causes(
      "[2026-01-01 00:00:00.000] [vat] [warning] a wrong token, number 1 of its connection\n"
      "[2026-01-01 00:00:00.000] [vat] [error] storage: the disk is gone\n");
  EXPECT_EQ(causes.counts.size(), 1U);
  ASSERT_EQ(causes.unexplained.size(), 1U);
  EXPECT_THAT(causes.unexplained[0], testing::HasSubstr("the disk is gone"));
}

// The growth of a line is exact. For other values it is a least-squares fit: at the positions -1.5,
// -0.5, 0.5 and 1.5 it is (6 * -0.5 + 6 * 1.5) / 5 per step.
TEST(BenchSoak, FindsTheGrowthOfALine) {
  EXPECT_NEAR(bench::find_growth({5, 5.5, 6, 6.5, 7}), 2, 1e-12);
  EXPECT_NEAR(bench::find_growth({0, 6, 0, 6}), 3 * 6.0 / 5, 1e-12);
  EXPECT_THROW(bench::find_growth({1}), std::invalid_argument);
}

// Growth of more than a twentieth is a leak. The first rest does not count.
TEST(BenchSoak, DistinguishesLeaksFromSwings) {
  EXPECT_TRUE(bench::is_flat({10, 40, 41, 40, 41, 40}, 0.05));
  EXPECT_TRUE(bench::is_flat({10, 40, 40.4, 40.8, 41.2, 41.6}, 0.05)) << "growth below the limit";
  EXPECT_FALSE(bench::is_flat({10, 40, 40.6, 41.2, 41.8, 42.4}, 0.05));
  EXPECT_THROW(bench::is_flat({40, 40}, 0.05), std::invalid_argument);
}

// A short version of the ten-minute run in tests/bench/README.md.
TEST(BenchSoak, ServerSurvivesAllKindsOfClients) {
  const Table table = bench_table("soak", {"soak", "--seconds", "10"});
  for (const char* manner : {"joins", "answered", "frames", "rubbish", "flood", "stalls"}) {
    EXPECT_GT(table.number(0, manner), 20) << manner;
  }
}

// Smaller and shorter runs than those of the targets: sizes do not depend on the load of the
// machine, but times do.
TEST(BenchCodec, FramesAreAsSmallAsTheyMustBeAndKeepTheirError) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_bench({"codec", "--quick", "--case", "dam-break-30k", "--case", "pool-settled", "--case",
                 "pool-asleep", "--case", "figure-2", "--case", "figure-2-asleep", "--no-web",
                 "--output", folder.path().string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Table targets = read_csv((folder.path() / "targets.csv").string());
  std::size_t sizes = 0;
  for (std::size_t row = 0; row < targets.rows.size(); ++row) {
    const std::string what = targets.text(row, "target");
    if (what.find("decode [") != std::string::npos) continue;
    if (what.find("encode [") != std::string::npos) continue;
    ++sizes;
    EXPECT_EQ(targets.text(row, "passed"), "true") << what << targets.text(row, "measured");
  }
  EXPECT_EQ(sizes, 8U);
  const Table table = read_csv((folder.path() / "codec.csv").string());
  std::size_t rows = 0;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (table.text(row, "case") != "figure-2") continue;
    ++rows;
    // Half a quantum, plus the rounding of origin + quantum * steps.
    EXPECT_LE(table.number(row, "greatest error found [allowed]"), 1 + 1e-9);
    EXPECT_GT(table.number(row, "greatest error found [allowed]"), 0.5);
  }
  EXPECT_EQ(rows, 8U);
  EXPECT_THAT(result.out, HasSubstr("16 bits, zstd"));
}

}  // namespace
}  // namespace vat::test::bench_server_test
