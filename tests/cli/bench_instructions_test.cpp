#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bench/instructions/callgrind.h"
#include "tests/bench/instructions/stored_counts.h"
#include "tests/cli/program.h"

namespace vat::bench::bench_instructions_test {
namespace {

using test::ProgramResult;
using test::run_bench;
using test::TemporaryFolder;

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
}  // namespace vat::bench::bench_instructions_test
