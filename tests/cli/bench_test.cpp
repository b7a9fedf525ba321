#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"
#include "tests/cli/readers.h"

namespace vat::test {
namespace {

TEST(Bench, RowsAreConsistent) {
  const TemporaryFolder folder;
  const std::string file = folder.file("bench.csv");
  const ProgramResult result =
      run_vat({"bench", "--quick", "--output", file, test_scene("pair"), test_scene("mixed")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Table table = read_csv(file);
  ASSERT_GE(table.rows.size(), 2u);
  EXPECT_EQ(lines_of(result.out).size(), table.rows.size() + 1);
  EXPECT_EQ(table.text(0, "scene"), "pair");
  EXPECT_EQ(table.text(table.rows.size() - 1, "scene"), "mixed");
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const double ms = table.number(row, "ms_per_step_median");
    EXPECT_EQ(table.number(row, "steps"), 200);  // 0.2 s in steps of 1 ms
    EXPECT_GE(ms, table.number(row, "ms_per_step_min"));
    EXPECT_NEAR(table.number(row, "real_time_factor") * ms, 1, 1e-9);
    EXPECT_NEAR(table.number(row, "particle_steps_per_second") * ms,
                1e3 * table.number(row, "particles"), 1e-6);
    if (row > 0 && table.text(row, "scene") == table.text(row - 1, "scene")) {
      EXPECT_EQ(table.text(row, "state_hash"), table.text(row - 1, "state_hash"));
    }
  }
}

TEST(Bench, FailedRunIsAnError) {
  const ProgramResult result = run_vat({"bench", "--quick", test_scene("unstable")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, testing::HasSubstr("unstable.json/bodies/1: a step failed"));
}

}  // namespace
}  // namespace vat::test
