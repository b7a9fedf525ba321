#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/bench/race/peer_run.h"
#include "tests/cli/program.h"
#include "tests/support/temporary_folder.h"

namespace vat::bench::bench_race_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTimes =
    "INFO: Time sum: SimStep: 2500.5 ms\n"
    "INFO: Total number: Time step size: 0.5\n";

/// A program that prints `text` and writes its arguments to the file "arguments".
fs::path make_program(const test::TemporaryFolder& folder, const std::string& text, int exit_code) {
  const fs::path program = fs::path(folder.path()) / "SPHSimulator";
  std::ofstream(program) << "#!/bin/sh\nprintf '%s' \"" << text << "\"\n"
                         << "echo \"$OMP_NUM_THREADS $*\" >arguments\nexit " << exit_code << '\n';
  fs::permissions(program, fs::perms::owner_all);
  return program;
}

TEST(BenchRace, SceneFillsACubicMetreByItsParticles) {
  const Json scene = peer_scene({.program = "bin/SPHSimulator", .edge = 22});
  const Json& block = scene["FluidBlocks"][0];
  // The outer particles are one spacing from the walls, so the block has 23 spacings.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(block["end"][axis].get<Real>() - block["start"][axis].get<Real>(), 23.0 / 22,
                1e-12);
  }
  EXPECT_EQ(scene["Configuration"]["simulationMethod"], 4);
  EXPECT_EQ(scene["RigidBodies"][0]["geometryFile"].get<std::string>(),
            (fs::current_path() / "data/models/UnitBox.obj").string());
  const Json tait =
      peer_scene({.program = "SPHSimulator", .edge = 22, .solver = PressureSolver::tait});
  EXPECT_EQ(tait["Configuration"]["simulationMethod"], 0);
  EXPECT_NEAR(tait["Configuration"]["cflMaxTimeStepSize"].get<Real>(), 0.4 / 22 / 18.7, 1e-12);
}

TEST(BenchRace, TimeIsThatOfAllStepsPerSimulatedSecond) {
  EXPECT_NEAR(parse_peer_times(kTimes).value(), 5.001, 1e-12);
  EXPECT_EQ(parse_peer_times("Time sum: SimStep: 2500 ms\n").errors()[0].code, "bad_output");
}

TEST(BenchRace, RunsTheProgramWithItsThreads) {
  const test::TemporaryFolder folder;
  PeerRun run{.program = make_program(folder, kTimes, 0), .threads = 3, .seconds = 0.25};
  EXPECT_NEAR(run_peer(run, folder.path()).value(), 5.001, 1e-12);
  std::string arguments;
  std::getline(std::ifstream(fs::path(folder.path()) / "arguments"), arguments);
  EXPECT_THAT(arguments,
              testing::AllOf(testing::StartsWith("3 --no-gui"), testing::HasSubstr("--stopAt 0.25"),
                             testing::EndsWith("peer.json")));
  run.program = make_program(folder, "no scene", 1);
  EXPECT_THAT(run_peer(run, folder.path()).errors()[0].message, testing::HasSubstr("no scene"));
}

}  // namespace
}  // namespace vat::bench::bench_race_test
