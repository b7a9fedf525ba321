#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <fstream>

#include "protocol/scene/scene_json.h"
#include "server/cli/common/scene_argument.h"
#include "server/operations/choose_device.h"
#include "tests/cli/program.h"
#include "tests/cli/readers.h"
#include "tests/support/thread_runner.h"

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

Simulation start_of(const std::string& scene) {
  return Simulation::create(load_scene(scene, "").value()).value();
}

TEST(ChooseDevice, TakesTheFasterOne) {
  struct Case {
    int device;  // seconds of the steps
    int cpu;
    bool on_cpu;
  };
  const Simulation simulation = start_of(kDamBreak);
  ThreadRunner runner(1);
  for (const Case& one : {Case{1, 2, false}, Case{2, 1, true}, Case{1, 1, true}}) {
    const std::array<int, 4> times{0, one.device, 5, 5 + one.cpu};
    const TimeSource now = [&, next = times.begin()]() mutable {
      return std::chrono::steady_clock::time_point{std::chrono::seconds(*next++)};
    };
    const DeviceChoice choice = choose_device({.is_auto = true}, simulation, runner, now);
    EXPECT_EQ(choice.is_cpu, one.on_cpu) << one.device << " s, and on the CPU " << one.cpu << " s";
    EXPECT_FALSE(choice.is_auto);
  }
}

TEST(ChooseDevice, LeavesSmallScenesToTheCpu) {
  ThreadRunner runner(1);
  const TimeSource now = [] {
    ADD_FAILURE() << "a measurement";
    return std::chrono::steady_clock::time_point{};
  };
  Scene scene = load_scene(kDamBreak, "").value();
  BodyDescription& body = scene.bodies[0];
  body.shape = BoxShape{std::get<BoxShape>(body.shape).center, Vec3(4, 4, 4) * body.spacing};
  const Simulation small = Simulation::create(scene).value();
  ASSERT_LT(small.particle_count(), kLeastForDevice);
  EXPECT_TRUE(choose_device({.is_auto = true}, small, runner, now).is_cpu);
}

// No device has another kernel.
TEST(ChooseDevice, MeasuresOnlyScenesThatADeviceTakes) {
  ThreadRunner runner(1);
  const TimeSource now = [] {
    ADD_FAILURE() << "a measurement";
    return std::chrono::steady_clock::time_point{};
  };
  Scene scene = load_scene(kDamBreak, "").value();
  scene.numerics.control = StepControl::local;
  const Simulation other = Simulation::create(scene).value();
  ASSERT_GE(other.particle_count(), kLeastForDevice);
  EXPECT_TRUE(choose_device({.is_auto = true}, other, runner, now).is_cpu);
}

TEST(DeviceCommand, TakesAnAutomaticDevice) {
  const ProgramResult result =
      run_vat({"simulate", kDamBreak, "--until", "0.02", "--hash", "--device", "auto"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, ContainsRegex("^hash [0-9a-f]{16}"));
}

TEST(DeviceCommand, TakesTheDeviceOfTheSceneUnlessAnOptionNamesOne) {
  const TemporaryFolder folder;
  Json scene = write_scene(load_scene(kDamBreak, "").value());
  const auto simulate = [&](const std::string& device, std::vector<std::string> options) {
    scene["numerics"]["device"] = device;
    const std::string file = folder.file("scene.json");
    std::ofstream(file) << scene;
    options.insert(options.begin(), {"simulate", file, "--until", "0.02", "--hash"});
    return run_vat(options);
  };
  EXPECT_THAT(simulate("opencl:0:fast", {}).out, HasSubstr("opencl-fast"));
  EXPECT_THAT(simulate("opencl:0", {"--device", "cpu", "--isa", "baseline"}).out,
              HasSubstr("baseline"));
  EXPECT_THAT(simulate("opencl:99", {}),
              exits(1, HasSubstr("/numerics/device: opencl:99 does not exist")));
}

TEST(DeviceCommand, OfTheServerMustExist) {
  EXPECT_THAT(run_vat({"serve", "--port", "0", "--device", "opencl:99"}),
              exits(1, HasSubstr("/device: opencl:99 does not exist")));
  EXPECT_THAT(run_vat({"serve", "--device", "gpu"}),
              exits(2, HasSubstr("must be scene, cpu, auto, opencl")));
}

TEST(DeviceCommand, BenchMeasuresADeviceBesideTheCpu) {
  const TemporaryFolder folder;
  const std::string results = folder.file("results");
  const ProgramResult result =
      run_bench({"speed", "--quick", "--repetitions", "2", "--threads", "1", "--device", "opencl",
                 "--case", "dam-break-1k-tait", "--output", results});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Table table = read_csv(results + "/speed.csv");
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.number(0, "threads"), 1);
  EXPECT_EQ(table.number(1, "threads"), 0);
  EXPECT_EQ(table.text(1, "instruction set"), "opencl:0");
  EXPECT_EQ(table.number(0, "steps"), table.number(1, "steps"));
  EXPECT_NE(table.text(0, "state hash"), table.text(1, "state hash"));
  const std::string refused = folder.file("refused.json");
  std::ifstream clay(VAT_SOURCE_DIR "/protocol/scenes/clay.json");
  nlohmann::json scene = nlohmann::json::parse(clay);
  scene["numerics"]["control"] = "adaptive";
  std::ofstream(refused) << scene;
  EXPECT_THAT(run_bench({"speed", "--quick", "--device", "opencl", refused}),
              exits(1, HasSubstr("/numerics/control: must be fixed")));
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

}  // namespace
}  // namespace vat::test::device_test
