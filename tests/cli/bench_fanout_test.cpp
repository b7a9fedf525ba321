#include <gmock/gmock.h>

#include <cmath>

#include "protocol/frame_codec.h"
#include "tests/bench/fanout/frame_facts.h"
#include "tests/bench/fanout/segments.h"
#include "tests/cli/program.h"
#include "tests/cli/readers.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::bench_fanout_test {
namespace {

std::string_view text_of(const std::vector<std::uint8_t>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Beside the decoder: the load reads the header by itself.
TEST(BenchFanout, ReadsWhatTheHeaderSays) {
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

// Where all segments are alike, every draw gives the same. An odd one is missing in 0.9^10, a
// third, of the draws: the interval has both ratios.
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

// One viewer at the scene's rate: what the machine does beside that only makes it less.
TEST(BenchFanout, CountsTheFramesOfAViewer) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_bench({"fanout", "--quick", "--case", "viewers-1", "--output", folder.path().string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Table table = read_csv((folder.path() / "fanout.csv").string());
  ASSERT_EQ(table.rows.size(), 1U);
  const double rate = table.number(0, "frames per second");
  EXPECT_GT(rate, 0);
  EXPECT_LE(rate, 31) << "30 ticks a second, and one that may lie on the edge of each second";
  EXPECT_GT(table.number(0, "frame bytes"), 0);
  EXPECT_GT(table.number(0, "age 99 % [ms]"), 0);
}

}  // namespace
}  // namespace vat::test::bench_fanout_test
