// `vat record`: interrupted recordings continue with the same bytes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "protocol/recording/recording_file.h"
#include "tests/cli/program.h"
#include "tests/support/wait.h"

namespace vat::test::record_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> recording(const std::string& output, const std::string& until,
                                   const std::string& every = "0.03") {
  return {"record", test_scene("mixed"), "--until", until, "--every", every, "--output", output};
}

/// Time between frames [s]. A tick has 0.02 s, so that a signal is noticed at a frame or between
/// two frames.
class Resumption : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Record, Resumption, testing::Values("0.02", "0.03"));

TEST_P(Resumption, HasTheBytesOfAnUninterruptedRun) {
  const TemporaryFolder folder;
  const std::string name = folder.file("a.vatrec");
  {
    RunningProgram program(recording(name, "1e4", GetParam()));
    ASSERT_TRUE(wait_until([&] {
      std::error_code missing;
      return std::filesystem::file_size(name + ".part", missing) > 0 && !missing;
    }));
    program.send(SIGINT);
    const ProgramResult result = program.finish();
    EXPECT_EQ(result.exit_code, 128 + SIGINT);
    EXPECT_THAT(result.err, HasSubstr("--resume continues"));
  }
  EXPECT_THAT(folder.names(), ElementsAre("a.vatrec", "a.vatrec.state"));
  // The recording is complete up to here.
  const ProgramResult replayed = run_vat({"replay", name});
  EXPECT_THAT(replayed.err, HasSubstr("contains frames"));
  // Some frames more, whatever the speed of the machine.
  const std::size_t frames = RecordingFile::open(name).value().index().frames().size();
  const std::string end = std::to_string(0.03 * static_cast<double>(frames + 20));
  std::vector<std::string> rest = recording(name, end, GetParam());
  rest.emplace_back("--resume");
  const ProgramResult resumed = run_vat(rest);
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_THAT(folder.names(), ElementsAre("a.vatrec"));
  const std::string whole = folder.file("b.vatrec");
  ASSERT_EQ(run_vat(recording(whole, end, GetParam())).exit_code, 0);
  EXPECT_TRUE(read_file(name) == read_file(whole));
}

TEST(Record, WithoutAStateIsNotResumed) {
  const TemporaryFolder folder;
  const std::string name = folder.file("a.vatrec");
  ASSERT_EQ(run_vat(recording(name, "0.1")).exit_code, 0);
  std::vector<std::string> arguments = recording(name, "0.2");
  arguments.emplace_back("--resume");
  EXPECT_THAT(run_vat(arguments),
              exits(1, HasSubstr("only an interrupted recording can be resumed")));
  EXPECT_THAT(folder.names(), ElementsAre("a.vatrec"));
}

}  // namespace
}  // namespace vat::test::record_test
