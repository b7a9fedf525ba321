#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "protocol/json/json_reader.h"
#include "tests/bench/document/page_tables.h"
#include "tests/bench/kernels/kernel_counts.h"
#include "tests/bench/report/csv_file.h"
#include "tests/bench/report/table.h"

namespace vat::bench::bench_kernels_test {
namespace {

using testing::HasSubstr;

constexpr const char* kColumns =
    "kernel,runs,items,single,double,instructions,accessed,of_groups,distinct\n";

Result<std::vector<KernelCounts>> read(const std::string& text) {
  return read_kernel_counts(parse_csv(text).value(), 2, 10);
}

TEST(BenchKernels, CountsAreMeansOfRunsAndParticles) {
  const auto kernels = read(std::string(kColumns) +
                            "move,2,32,400,200,6000,3200,1600,800\nsum,6,1,0,0,60,60,60,60\n");
  ASSERT_TRUE(kernels);
  ASSERT_EQ(kernels.value().size(), 2U);
  const KernelCounts& move = kernels.value()[0];
  EXPECT_EQ(move.name, "move");
  EXPECT_EQ(move.runs, 1);
  EXPECT_EQ(move.single_operations, 20);
  EXPECT_EQ(move.double_operations, 10);
  EXPECT_EQ(move.instructions, 300);
  EXPECT_EQ(move.accessed_bytes, 160);
  EXPECT_EQ(move.group_bytes, 80);
  EXPECT_EQ(move.distinct_bytes, 40);
  EXPECT_EQ(kernels.value()[1].runs, 3);
  EXPECT_EQ(kernels.value()[1].instructions, 1);
}

TEST(BenchKernels, RejectsIncompleteCounts) {
  const std::pair<std::string, std::string> cases[] = {
      {kColumns, "has no kernels"},
      {"kernel,runs\nmove,2\n", "has no column 'single'"},
      {std::string(kColumns) + "move,0,1,1,1,1,1,1,1\n", "move has no runs"},
      {std::string(kColumns) + "move,2,1,x,1,1,1,1,1\n", "row 2: 'single' must be a whole number"},
  };
  for (const auto& [text, message] : cases) {
    const auto kernels = read(text);
    ASSERT_FALSE(kernels) << text;
    EXPECT_THAT(kernels.errors()[0].message, HasSubstr(message));
  }
}

// Each unit of the GPU bounds a kernel in turn. Starting a kernel takes 4 microseconds.
TEST(BenchKernels, SlowestUnitBoundsTheTime) {
  const Gpu gpu{"G", 1e12, 1e10, 1e11};
  const std::pair<KernelCounts, Real> cases[] = {
      {{.instructions = 1000, .distinct_bytes = 10}, 4e-6 + 1e-3},
      {{.double_operations = 100, .instructions = 1000}, 4e-6 + 1e-2},
      {{.instructions = 1000, .distinct_bytes = 1000}, 4e-6 + 1e-2},
  };
  for (const auto& [kernel, seconds] : cases) {
    EXPECT_DOUBLE_EQ(predict_run(kernel, gpu, 1e6), seconds);
  }
  KernelCounts often = cases[0].first;
  often.runs = 3;
  EXPECT_DOUBLE_EQ(predict_step({often}, gpu, 1e6), 3 * cases[0].second);
}

TEST(BenchKernels, TablesHaveThreeDigits) {
  const Json kernels = Json::parse(R"([
    {"scene": "s", "kernel": "move", "runs per step": 1, "single": 2.34567, "double": 33,
     "instructions": 12345, "accessed bytes": 180, "bytes of groups": 1.5,
     "distinct bytes": 0.0123456}])");
  EXPECT_THAT(to_markdown(kernels_table(kernels)),
              HasSubstr("| s | `move` | 1 | 2.35 | 33 | 12345 | 180 | 1.5 | 0.0123 |"));
  const Json times = Json::parse(R"([{"scene": "s", "A [ms]": 1.2345, "B [ms]": 61}])");
  EXPECT_THAT(to_markdown(times_table(times)), HasSubstr("| scene | A [ms] | B [ms] |"));
  EXPECT_THAT(to_markdown(times_table(times)), HasSubstr("| s | 1.23 | 61 |"));
}

}  // namespace
}  // namespace vat::bench::bench_kernels_test
