#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/support/instruction_set.h"
#include "tests/cli/program.h"
#include "tests/cli/readers.h"

namespace vat::test::bench_test {
namespace {

TEST(BenchSpeed, RowsAreConsistent) {
  const TemporaryFolder folder;
  const ProgramResult result = run_bench(
      {"speed", "--quick", "--repetitions", "2", "--threads", "1", "--threads", "2", "--isa",
       "baseline", "--output", folder.file("results"), test_scene("pair"), test_scene("mixed")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Table table = read_csv(folder.file("results/speed.csv"));
  ASSERT_EQ(table.rows.size(), 4u);
  EXPECT_EQ(lines_of(result.out).size(), table.rows.size() + 3);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    EXPECT_EQ(table.text(row, "case"), test_scene(row < 2 ? "pair" : "mixed"));
    EXPECT_EQ(table.number(row, "threads"), row % 2 == 0 ? 1 : 2);
    EXPECT_EQ(table.text(row, "instruction set"), "baseline");
    EXPECT_EQ(table.number(row, "repetitions"), 2);
    EXPECT_EQ(table.number(row, "steps"), 100);  // 0.1 s in steps of 1 ms
    const double ms = table.number(row, "ms per step");
    EXPECT_GE(ms, table.number(row, "least ms per step"));
    EXPECT_NEAR(table.number(row, "real-time factor") * ms, 1, 1e-9);
    EXPECT_NEAR(table.number(row, "wall s per simulated s"), ms, 1e-9 * ms);
    EXPECT_NEAR(table.number(row, "particle steps per s") * ms,
                1e3 * table.number(row, "particles"), 1e-6);
    EXPECT_EQ(table.text(row, "state hash"), table.text(row / 2 * 2, "state hash"));
  }
}

TEST(BenchSpeed, StagesAndTheRestAreTheWholeStep) {
  const Table table = bench_table(
      "stages", {"speed", "--quick", "--threads", "1", "--case", "dam-break-1k-incompressible"});
  double share = 0;
  std::vector<std::string> names;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    EXPECT_GT(table.number(row, "share"), 0);
    share += table.number(row, "share");
    names.push_back(table.text(row, "stage"));
  }
  EXPECT_NEAR(share, 1, 1e-9);
  EXPECT_THAT(names, testing::IsSupersetOf({"sort_liquid", "project_velocities", "rest"}));
}

TEST(BenchSpeed, FailedRunsAndUnknownScenesAreErrors) {
  EXPECT_THAT(run_bench({"speed", "--quick", test_scene("unstable")}),
              exits(1, testing::HasSubstr("unstable.json/bodies/1: a step failed")));
  EXPECT_THAT(run_bench({"speed", "atlantis"}),
              exits(1, testing::HasSubstr("atlantis: is not in the catalogue, which has")));
}

TEST(BenchUsage, WrongWordsAreNamed) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{}, "subcommand"},
      {{"conquer"}, "conquer"},
      {{"speed", "--threads", "0"}, "--threads"},
      {{"speed", "--isa", "sse9"}, "baseline, avx2, avx512"},
      {{"speed", "--repetitions", "0"}, "--repetitions"},
      {{"speed", "--fast"}, "--fast"},
      {{"validate", "--threads", "0"}, "--threads"},
      {{"validate", "--case"}, "--case"},
      {{"validate", "--device", "abacus"}, "--device"},
  };
  for (const auto& [arguments, named] : wrong) {
    EXPECT_THAT(run_bench(arguments), exits(2, testing::HasSubstr(named)));
  }
}

TEST(BenchUsage, ListedCasesAreThoseThatAnErrorNames) {
  for (const char* command : {"speed", "validate"}) {
    const ProgramResult list = run_bench({command, "--list"});
    EXPECT_EQ(list.exit_code, 0);
    const ProgramResult unknown = run_bench({command, "--case", "DEF-99"});
    EXPECT_EQ(unknown.exit_code, 1);
    EXPECT_THAT(unknown.err, testing::StartsWith("DEF-99: there is no such case; there are"));
    for (const std::string& name : lines_of(list.out)) {
      EXPECT_THAT(unknown.err, testing::HasSubstr(' ' + name));
    }
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
  // A heading, an empty line, the columns and a separator precede the rows.
  EXPECT_EQ(lines_of(read_file(folder.file("results/validation.md"))).size(),
            table.rows.size() + 4);
  EXPECT_THAT(read_file(folder.file("results/validation.json")), testing::StartsWith("[\n"));
}

TEST(BenchRounding, MeasuresADeviceAndTheCpu) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_bench({"rounding", "--quick", "--device", "opencl:0", "--output", folder.file("results")});
  ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  const Table table = read_csv(folder.file("results/rounding.csv"));
  ASSERT_EQ(table.rows.size(), 5U);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    EXPECT_EQ(table.text(row, "passed"), "true");
    EXPECT_GT(table.number(row, "change"), 0) << table.text(row, "scene");
    EXPECT_GT(table.number(row, "change on the CPU"), 0);
  }
}

TEST(Bench, OutputMeasuresEachFormat) {
  const Table table = bench_table("output", {"output", "--case", "dam-break-1k"});
  ASSERT_EQ(table.rows.size(), 7u);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    EXPECT_GT(table.number(row, "write [ms]"), 0);
    EXPECT_EQ(table.number(row, "particles"), 1024);
    EXPECT_GE(table.number(row, "bytes per particle"), 12);  // a position in single precision
  }
  EXPECT_EQ(table.text(1, "format"), ".npy");
  EXPECT_NEAR(table.number(1, "bytes per particle"), 48, 0.1);
  EXPECT_EQ(run_bench({"output", "--case", "none"}).exit_code, 1);
}

}  // namespace
}  // namespace vat::test::bench_test
