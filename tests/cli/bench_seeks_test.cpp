#include <gmock/gmock.h>

#include "tests/cli/program.h"
#include "tests/cli/readers.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::bench_seeks_test {
namespace {

TEST(BenchSeeks, GoesToMomentsOfARecording) {
  const TemporaryFolder folder;
  const ProgramResult result = run_bench({"seeks", "--ticks", "150", "--seeks", "5", "--scene",
                                          "water-drop", "--output", folder.path().string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Table table = read_csv((folder.path() / "seeks.csv").string());
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.number(0, "ticks"), 150);
  EXPECT_EQ(table.number(0, "seeks"), 5);
  EXPECT_GT(table.number(0, "checkpoints"), 0);
  EXPECT_GT(table.number(0, "median [ms]"), 0);
  EXPECT_LE(table.number(0, "median [ms]"), table.number(0, "99 % [ms]"));
  EXPECT_LE(table.number(0, "99 % [ms]"), table.number(0, "longest [ms]"));
  EXPECT_EQ(table.number(0, "within") == 5, table.number(0, "longest [ms]") <= 200);
}

TEST(BenchSeeks, SaysWhatTheServerRefuses) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_bench({"seeks", "--scene", "gone", "--output", folder.path().string()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, testing::HasSubstr("gone"));
}

}  // namespace
}  // namespace vat::test::bench_seeks_test
