#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/bench/instructions/callgrind.h"
#include "tests/bench/instructions/stored_counts.h"
#include "tests/bench/speed/comparison.h"
#include "tests/cli/program.h"

namespace vat::bench::bench_compare_test {
namespace {

using test::exits;
using test::ProgramResult;
using test::run_bench;
using test::TemporaryFolder;

TimedRow row(const std::string& name, Real wall, Real least_share = 0.9) {
  TimedRow row;
  row.name = name;
  row.threads = "1";
  row.instruction_set = "avx2";
  row.wall_per_simulated = wall;
  row.ms_per_step = 4 * wall;
  row.least_ms_per_step = least_share * row.ms_per_step;
  row.steps = "10";
  row.state_hash = "00";
  return row;
}

TEST(BenchCompare, CsvIsReadAsItIsWritten) {
  const Table table{{"a", "b, c"}, {{"say \"no\"", 0.5}, {"two\nlines", std::uint64_t{7}}}};
  const Result<CsvFile> file = parse_csv(to_csv(table));
  ASSERT_TRUE(file);
  EXPECT_THAT(file.value().columns, testing::ElementsAre("a", "b, c"));
  EXPECT_THAT(file.value().rows, testing::ElementsAre(testing::ElementsAre("say \"no\"", "0.5"),
                                                      testing::ElementsAre("two\nlines", "7")));
  EXPECT_THAT(parse_csv("a,b\r\n,x\r\n").value().rows,
              testing::ElementsAre(testing::ElementsAre("", "x")));
}

TEST(BenchCompare, MalformedCsvIsRefused) {
  const std::pair<const char*, const char*> wrong[] = {
      {"", "is empty"},
      {"a,b\n1\n", "row 2: has 1 cells and the header 2"},
      {"a\n\"open\n", "row 2: a quote is not closed"},
      {"a\n\"x\"y\n", "row 2: text follows a closing quote"},
  };
  for (const auto& [text, message] : wrong) {
    const Result<CsvFile> file = parse_csv(text);
    ASSERT_FALSE(file) << text;
    EXPECT_EQ(file.errors().front().message, message);
  }
}

// Both the median and the minimum exceed the tolerance, since a busy machine increases medians.
TEST(BenchCompare, SlowerNeedsMedianAndMinimum) {
  const std::vector<TimedRow> before = {row("a", 1), row("b", 1), row("c", 1), row("d", 1)};
  const std::vector<TimedRow> after = {row("a", 1.2), row("b", 1.2, 0.9 / 1.2), row("c", 1.09),
                                       row("d", 0.8)};
  const Comparison compared = compare_rows(before, after, 0.1).value();
  ASSERT_EQ(compared.pairs.size(), 4u);
  EXPECT_TRUE(compared.pairs[0].slower);
  EXPECT_NEAR(compared.pairs[0].least_ratio, 1.2, 1e-12);
  EXPECT_FALSE(compared.pairs[1].slower);
  EXPECT_NEAR(compared.pairs[1].least_ratio, 1, 1e-12);
  EXPECT_FALSE(compared.pairs[2].slower);
  EXPECT_TRUE(compared.pairs[3].faster);
  EXPECT_EQ(compared.slower_count(), 1u);
  EXPECT_NEAR(compared.mean_ratio(), std::pow(1.2 * 1.2 * 1.09 * 0.8, 0.25), 1e-12);
}

TEST(BenchCompare, RowsAreMatchedByCaseThreadsAndInstructionSet) {
  TimedRow two = row("a", 3);
  two.threads = "2";
  TimedRow baseline = row("a", 5);
  baseline.instruction_set = "baseline";
  TimedRow changed = row("a", 1);
  changed.steps = "12";
  changed.state_hash = "01";
  const Comparison compared = compare_rows({row("a", 1), two}, {baseline, changed}, 0.1).value();
  ASSERT_EQ(compared.pairs.size(), 1u);
  EXPECT_EQ(compared.pairs[0].ratio, 1);
  ASSERT_EQ(compared.only_before.size(), 1u);
  EXPECT_EQ(compared.only_before[0].title(), "a, 2 threads, avx2");
  ASSERT_EQ(compared.only_after.size(), 1u);
  EXPECT_EQ(compared.only_after[0].title(), "a, 1 thread, baseline");
  EXPECT_EQ(to_csv(comparison_table(compared)),
            "case,threads,instruction set,before [s/s],after [s/s],after / before,by least,steps,"
            "state,verdict\na,1,avx2,1,1,1,1,10 to 12,changed,\n");
  EXPECT_FALSE(compare_rows({two}, {baseline}, 0.1));
}

// Compares a result of the benchmark with a copy that the test made slower.
TEST(BenchCompare, ExitCodeReportsSlowerCases) {
  const TemporaryFolder folder;
  const ProgramResult measured = run_bench({"speed", "--quick", "--threads", "1", "--output",
                                            folder.file("a"), "--case", "dam-break-1k-tait"});
  ASSERT_EQ(measured.exit_code, 0) << measured.err;
  const std::string before = folder.file("a/speed.csv");
  CsvFile file = read_csv_file(before).value();
  Table slower{file.columns, {}};
  for (std::size_t i = 0; i < file.columns.size(); ++i) {
    std::string& cell = file.rows[0][i];
    const bool is_time = file.columns[i] == "wall s per simulated s";
    slower.rows.resize(1);
    slower.rows[0].push_back(is_time ? std::to_string(1.2 * std::stod(cell)) : cell);
  }
  const std::string after = folder.file("b.csv");
  ASSERT_TRUE(write_text(after, to_csv(slower)));
  EXPECT_EQ(run_bench({"compare", before, before}).exit_code, 0);
  const ProgramResult result = run_bench({"compare", before, after});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, testing::HasSubstr("1 of 1 rows are slower by more than 10 %"));
  EXPECT_THAT(result.out, testing::HasSubstr("| SLOWER |"));
  EXPECT_EQ(run_bench({"compare", before, after, "--tolerance", "25"}).exit_code, 0);
  EXPECT_EQ(run_bench({"compare", after, before}).exit_code, 0);
}

TEST(BenchCompare, OtherFilesAreNamed) {
  const TemporaryFolder folder;
  const std::string other = folder.file("other.csv");
  ASSERT_TRUE(write_text(other, "case,threads\na,1\n"));
  EXPECT_THAT(run_bench({"compare", other, other}),
              exits(1, testing::HasSubstr(other + ": has no column 'instruction set'")));
  for (const std::string& absent : {folder.file("none.csv"), folder.file(".")}) {
    EXPECT_THAT(run_bench({"compare", absent, other}),
                exits(1, testing::HasSubstr(absent + ": cannot be read")));
  }
}

const std::vector<StoredCount> kStored = {{"here", {"a", 1000}}, {"elsewhere", {"a", 5}}};

TEST(BenchInstructions, ThreePerCentMayBe) {
  EXPECT_TRUE(check_counts({{"a", 1030}}, kStored, "here"));
  EXPECT_TRUE(check_counts({{"a", 970}}, kStored, "here"));
  for (const std::uint64_t count : {1031u, 969u}) {
    const Status changed = check_counts({{"a", count}}, kStored, "here");
    ASSERT_FALSE(changed);
    EXPECT_EQ(changed.errors().front().path, "a");
    EXPECT_THAT(changed.errors().front().message,
                testing::AllOf(testing::HasSubstr("1000 are stored"), testing::HasSubstr("3.1 %"),
                               testing::HasSubstr("VAT_UPDATE_GOLDEN=1")));
  }
}

TEST(BenchInstructions, EveryScenesCountIsStored) {
  const Status missing = check_counts({{"a", 1000}, {"b", 1000}}, kStored, "here");
  ASSERT_FALSE(missing);
  ASSERT_EQ(missing.errors().size(), 1u);
  EXPECT_EQ(missing.errors().front().path, "b");
}

TEST(BenchInstructions, RenewalKeepsOtherBuilds) {
  const Table table = renewed({{"a", 7}, {"b", 8}}, kStored, "here");
  EXPECT_EQ(to_csv(table), "scene,build,instructions\na,here,7\nb,here,8\na,elsewhere,5\n");
  const auto again = read_stored_counts(parse_csv(to_csv(table)).value());
  ASSERT_TRUE(again);
  EXPECT_EQ(again.value()[1].count.instructions, 8u);
  EXPECT_FALSE(read_stored_counts(parse_csv("scene,build\na,here\n").value()));
  EXPECT_FALSE(read_stored_counts(parse_csv("scene,build,instructions\na,here,x\n").value()));
}

TEST(BenchInstructions, TotalIsThatOfCallgrind) {
  const TemporaryFolder folder;
  const std::string file = folder.file("out");
  ASSERT_TRUE(write_text(file, "events: Ir\nfn=(1) f\n12 34\n\ntotals: 567\n"));
  EXPECT_EQ(parse_callgrind_total(file).value(), 567u);
  ASSERT_TRUE(write_text(file, "events: Ir\n\ntotals: 0\n"));
  EXPECT_FALSE(parse_callgrind_total(file));  // the counted function has another name
  EXPECT_FALSE(parse_callgrind_total(folder.file("none")));
}

TEST(BenchInstructions, OtherBuildsAreSkippedWithAReason) {
  const TemporaryFolder folder;
  const std::string stored = folder.file("stored.csv");
  ASSERT_TRUE(write_text(stored, "scene,build,instructions\na,another compiler,5\n"));
  const ProgramResult result =
      run_bench({"instructions", "--check", stored, "--output", folder.file("out")});
  EXPECT_EQ(result.exit_code, 77);
  EXPECT_THAT(result.out,
              testing::AllOf(testing::HasSubstr("skipped"), testing::HasSubstr("another compiler"),
                             testing::HasSubstr(this_build())));
}

}  // namespace
}  // namespace vat::bench::bench_compare_test
