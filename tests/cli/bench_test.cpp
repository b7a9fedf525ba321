#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/support/instruction_set.h"
#include "tests/cli/program.h"
#include "tests/cli/readers.h"

namespace vat::test {
namespace {

TEST(BenchSpeed, RowsAreConsistent) {
  const TemporaryFolder folder;
  const std::string file = folder.file("bench.csv");
  const ProgramResult result =
      run_bench({"speed", "--quick", "--output", file, test_scene("pair"), test_scene("mixed")});
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

TEST(BenchSpeed, FailedRunIsAnError) {
  const ProgramResult result = run_bench({"speed", "--quick", test_scene("unstable")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, testing::HasSubstr("unstable.json/bodies/1: a step failed"));
}

TEST(BenchSpeed, UnknownSceneListsTheCatalogue) {
  const ProgramResult result = run_bench({"speed", "atlantis"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, testing::HasSubstr("atlantis: is not in the catalogue, which has"));
}

TEST(BenchUsage, WrongWordsAreNamed) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{}, "subcommand"},
      {{"conquer"}, "conquer"},
      {{"speed", "--output", "bench.txt"}, "must end in .csv"},
      {{"speed", "--fast"}, "--fast"},
      {{"validate", "--threads", "0"}, "--threads"},
      {{"validate", "--case"}, "--case"},
  };
  for (const auto& [arguments, named] : wrong) {
    const ProgramResult result = run_bench(arguments);
    EXPECT_EQ(result.exit_code, 2) << named;
    EXPECT_THAT(result.err, testing::HasSubstr(named));
  }
}

TEST(BenchValidate, ListedCasesAreThoseThatAnErrorNames) {
  const ProgramResult list = run_bench({"validate", "--list"});
  EXPECT_EQ(list.exit_code, 0);
  const ProgramResult unknown = run_bench({"validate", "--case", "DEF-99"});
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.err, testing::StartsWith("DEF-99: there is no such case; there are"));
  for (const std::string& name : lines_of(list.out)) {
    EXPECT_THAT(unknown.err, testing::HasSubstr(' ' + name));
  }
}

TEST(BenchValidate, TableIsWrittenThreeTimes) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_bench({"validate", "--quick", "--case", "DEF-1", "--output", folder.file("results")});
  ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  const Table table = read_csv(folder.file("results/validation.csv"));
  ASSERT_FALSE(table.rows.empty());
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    EXPECT_EQ(table.text(row, "case"), "DEF-1");
    EXPECT_EQ(table.text(row, "passed"), "true");
    EXPECT_THAT(table.text(row, "state hash"),
                testing::ContainsRegex(std::string("^[0-9a-f]+ ") +
                                       to_string(best_instruction_set()) + "$"));
  }
  // A heading, an empty line, the columns and a rule before the rows.
  EXPECT_EQ(lines_of(read_file(folder.file("results/validation.md"))).size(),
            table.rows.size() + 4);
  EXPECT_THAT(read_file(folder.file("results/validation.json")), testing::StartsWith("[\n"));
}

}  // namespace
}  // namespace vat::test
