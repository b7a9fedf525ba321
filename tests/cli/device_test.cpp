#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"
#include "tests/cli/readers.h"

// Commands on an OpenCL device. The test machine has the device PoCL, which computes on its
// processor.

namespace vat::test::device_test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::MatchesRegex;

const std::string kDamBreak = VAT_SOURCE_DIR "/protocol/scenes/dam-break.json";

TEST(DeviceCommand, ListsDevices) {
  const ProgramResult result = run_vat({"devices"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, ContainsRegex("opencl:0  .+ GB, [0-9]+ compute units, exact arithmetic"));
}

TEST(DeviceCommand, SimulatesOnADevice) {
  for (const char* arithmetic : {"exact", "fast"}) {
    std::string device = "opencl:0";
    if (arithmetic == std::string("fast")) device += ":fast";
    const ProgramResult result =
        run_vat({"simulate", kDamBreak, "--until", "0.02", "--hash", "--device", device});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out,
                MatchesRegex("hash [0-9a-f]{16} opencl-" + std::string(arithmetic) + "\n"));
    EXPECT_THAT(result.err, HasSubstr("device: 8 steps, opencl-"));
  }
}

TEST(DeviceCommand, RefusesDevicesAndScenes) {
  struct Case {
    std::string scene;
    std::string device;
    std::string message;
  };
  for (const Case& one : {Case{kDamBreak, "opencl:99", "/device: opencl:99 does not exist"},
                          Case{test_scene("mixed"), "opencl", "/bodies/1/kind: must be liquid"}}) {
    const ProgramResult result =
        run_vat({"simulate", one.scene, "--until", "0.02", "--device", one.device});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr(one.message));
  }
}

}  // namespace
}  // namespace vat::test::device_test
