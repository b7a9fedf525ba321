// Files of a run that a signal interrupts.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "tests/cli/program.h"
#include "tests/cli/readers.h"
#include "tests/support/wait.h"

namespace vat::test::interrupt_test {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

/// Waits until the file is larger than `size` bytes.
bool wait_for_size(const std::string& path, std::uintmax_t size) {
  return wait_until([&] {
    std::error_code missing;
    const std::uintmax_t found = std::filesystem::file_size(path, missing);
    return !missing && found > size;
  });
}

std::vector<std::string> endless_run(std::vector<std::string> options) {
  options.insert(options.begin(),
                 {"simulate", test_scene("mixed"), "--until", "1e6", "--every", "0.02", "--hash"});
  return options;
}

std::size_t mixed_particle_count() {
  const TemporaryFolder folder;
  const std::string file = folder.file("start.npy");
  EXPECT_EQ(run_vat({"simulate", test_scene("mixed"), "--until", "0", "--output", file}).exit_code,
            0);
  return read_npy(file).shape.at(1);
}

class Interrupt : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Signals, Interrupt, testing::Values(SIGINT, SIGTERM));

TEST_P(Interrupt, LeavesWholeFramesUnderThePartialName) {
  const std::size_t count = mixed_particle_count();
  const TemporaryFolder folder;
  RunningProgram program(
      endless_run({"--output", folder.file("run.csv"), "--diagnostics", folder.file("d.csv")}));
  ASSERT_TRUE(wait_for_size(folder.file("run.csv.part"), 100'000));
  program.send(GetParam());
  const ProgramResult result = program.finish();
  EXPECT_EQ(result.exit_code, 128 + GetParam());
  EXPECT_THAT(result.out, IsEmpty());  // no hash of an incomplete run
  ASSERT_EQ(lines_of(result.err).size(), 1u);
  EXPECT_THAT(result.err, HasSubstr("mixed.json: interrupted at t = "));
  EXPECT_THAT(result.err, EndsWith(" s; files that are not complete end in .part\n"));
  EXPECT_THAT(folder.names(), ElementsAre("d.csv.part", "run.csv.part"));
  const Table particles = read_csv(folder.file("run.csv.part"));
  const Table diagnostics = read_csv(folder.file("d.csv.part"));
  ASSERT_GT(diagnostics.rows.size(), 1u);
  ASSERT_EQ(particles.rows.size(), count * diagnostics.rows.size());
  EXPECT_EQ(particles.rows.back()[0], diagnostics.rows.back()[0]);
}

TEST(Interrupt, LeavesAReadableArray) {
  const std::size_t count = mixed_particle_count();
  const TemporaryFolder folder;
  RunningProgram program(endless_run({"--output", folder.file("run.npy")}));
  ASSERT_TRUE(wait_for_size(folder.file("run.npy.part"), 100'000));
  program.send(SIGINT);
  EXPECT_EQ(program.finish().exit_code, 128 + SIGINT);
  const Array array = read_npy(folder.file("run.npy.part"));
  ASSERT_EQ(array.shape.size(), 3u);
  EXPECT_GT(array.shape[0], 1u);
  EXPECT_EQ(array.shape[1], count);
  EXPECT_EQ(array.values.size(), array.shape[0] * count * 6);
}

TEST(Interrupt, LeavesOnlyWholeFilesOfASeries) {
  const TemporaryFolder folder;
  RunningProgram program(endless_run({"--output", folder.file("run.ply")}));
  ASSERT_TRUE(wait_for_size(folder.file("run-00000003.ply"), 0));
  program.send(SIGINT);
  EXPECT_EQ(program.finish().exit_code, 128 + SIGINT);
  const std::size_t count = mixed_particle_count();
  for (const std::string& name : folder.names()) {
    EXPECT_THAT(name, EndsWith(".ply"));
    EXPECT_EQ(read_ply(folder.file(name)).size(), count);
  }
}

}  // namespace
}  // namespace vat::test::interrupt_test
