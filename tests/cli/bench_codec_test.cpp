#include <gmock/gmock.h>

#include "tests/cli/program.h"
#include "tests/cli/readers.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::bench_codec_test {
namespace {

using testing::HasSubstr;

// On smaller and shorter runs than those for which they are meant: sizes do not depend on what else
// the machine does, times do.
TEST(BenchCodec, FramesAreAsSmallAsTheyMustBe) {
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
}

// Half a quantum, and the rounding of origin + quantum * steps.
TEST(BenchCodec, TheErrorHoldsOnEveryFrame) {
  const TemporaryFolder folder;
  const ProgramResult result = run_bench(
      {"codec", "--quick", "--case", "figure-2", "--no-web", "--output", folder.path().string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Table table = read_csv((folder.path() / "codec.csv").string());
  ASSERT_EQ(table.rows.size(), 8U);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    EXPECT_LE(table.number(row, "greatest error found [allowed]"), 1 + 1e-9);
    EXPECT_GT(table.number(row, "greatest error found [allowed]"), 0.5);
  }
  EXPECT_THAT(result.out, HasSubstr("16 bits, zstd"));
}

}  // namespace
}  // namespace vat::test::bench_codec_test
