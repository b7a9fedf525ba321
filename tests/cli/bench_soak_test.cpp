#include <gmock/gmock.h>

#include <stdexcept>

#include "tests/bench/soak/trend.h"
#include "tests/cli/program.h"
#include "tests/cli/readers.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::bench_soak_test {
namespace {

// A line's growth is found as it is; of values beside one, by least squares: with the places -1.5,
// -0.5, 0.5 and 1.5 it is (6 * -0.5 + 6 * 1.5) / 5 a step.
TEST(BenchSoak, FindsTheGrowthOfALine) {
  EXPECT_NEAR(bench::find_growth({5, 5.5, 6, 6.5, 7}), 2, 1e-12);
  EXPECT_NEAR(bench::find_growth({0, 6, 0, 6}), 3 * 6.0 / 5, 1e-12);
  EXPECT_THROW(bench::find_growth({1}), std::invalid_argument);
}

// What is beyond a twentieth is a leak; the first rest does not count.
TEST(BenchSoak, TellsLeaksFromSwings) {
  EXPECT_TRUE(bench::is_flat({10, 40, 41, 40, 41, 40}, 0.05));
  EXPECT_TRUE(bench::is_flat({10, 40, 40.4, 40.8, 41.2, 41.6}, 0.05)) << "less than matters";
  EXPECT_FALSE(bench::is_flat({10, 40, 40.6, 41.2, 41.8, 42.4}, 0.05));
  EXPECT_THROW(bench::is_flat({40, 40}, 0.05), std::invalid_argument);
}

// What takes ten minutes by hand, see tests/bench/README.md, for a little while.
TEST(BenchSoak, ServerOutlivesClientsOfAllManners) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_bench({"soak", "--seconds", "15", "--output", folder.path().string()});
  ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  const Table table = read_csv((folder.path() / "soak.csv").string());
  for (const char* manner : {"joins", "answered", "frames", "rubbish", "flood", "stalls"}) {
    EXPECT_GT(table.number(0, manner), 20) << manner << '\n' << result.out;
  }
}

}  // namespace
}  // namespace vat::test::bench_soak_test
