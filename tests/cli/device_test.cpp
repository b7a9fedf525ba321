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

// PoCL takes several times as long as the CPU's own path. A scene with solids has no device.
TEST(DeviceCommand, KeepsScenesThatAreFasterThereOnTheCpu) {
  for (const std::string& scene : {kDamBreak, test_scene("mixed")}) {
    const auto hash = [&](const std::string& device) {
      const ProgramResult result =
          run_vat({"simulate", scene, "--until", "0.02", "--hash", "--device", device});
      EXPECT_EQ(result.exit_code, 0) << result.err;
      return result.out;
    };
    EXPECT_EQ(hash("auto"), hash("cpu"));
  }
}

TEST(DeviceCommand, RecordsOnADevice) {
  const TemporaryFolder folder;
  const auto record = [&](const std::string& device) {
    return run_vat({"record", kDamBreak, "--until", "0.04", "--output", folder.file("a.vatrec"),
                    "--device", device});
  };
  const ProgramResult result = record("opencl:0");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("a.vatrec: 3 frames"));
  const ProgramResult refused = record("opencl:99");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("/device: opencl:99 does not exist"));
  EXPECT_THAT(folder.names(), testing::ElementsAre("a.vatrec"));
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
