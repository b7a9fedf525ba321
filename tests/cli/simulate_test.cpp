#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include <cmath>
#include <filesystem>

#include "tests/cli/program.h"
#include "tests/cli/readers.h"

namespace vat::test::simulate_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::Not;
using testing::StartsWith;

std::string hash_of(const std::string& scene, const std::vector<std::string>& options) {
  std::vector<std::string> arguments = {"simulate", scene, "--hash"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const ProgramResult result = run_vat(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, MatchesRegex("hash [0-9a-f]{16} [a-z0-9]+\n"));
  return result.out;
}

std::string hash_of(const std::vector<std::string>& options) {
  return hash_of(test_scene("mixed"), options);
}

TEST(Simulate, HashDoesNotDependOnThreads) {
  const std::string one = hash_of({"--until", "0.2", "--threads", "1"});
  EXPECT_EQ(hash_of({"--until", "0.2", "--threads", "2"}), one);
  EXPECT_EQ(hash_of({"--until", "0.2", "--threads", "4"}), one);
  EXPECT_NE(hash_of({"--until", "0.22"}), one);
}

// The first moments of the scenes as they are shipped.
TEST(Simulate, CatalogueScenesAreTheSameForAnyThreadCount) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(VAT_SOURCE_DIR "/protocol/scenes")) {
    if (entry.path().extension() != ".json") continue;
    const std::string scene = entry.path();
    const std::string one = hash_of(scene, {"--until", "0.1", "--threads", "1"});
    EXPECT_EQ(hash_of(scene, {"--until", "0.1", "--threads", "2"}), one) << scene;
    EXPECT_EQ(hash_of(scene, {"--until", "0.1", "--threads", "4"}), one) << scene;
    ++count;
  }
  EXPECT_GE(count, 6u);
}

TEST(Simulate, HashDoesNotDependOnOutputs) {
  const TemporaryFolder folder;
  const std::string without = hash_of({"--until", "0.2"});
  EXPECT_EQ(hash_of({"--until", "0.2", "--every", "0.007"}), without);
  EXPECT_EQ(hash_of({"--until", "0.2", "--every", "5"}), without);
  EXPECT_EQ(hash_of({"--until", "0.2", "--output", folder.file("a.vtk"), "--diagnostics",
                     folder.file("a.csv"), "--every", "0.05"}),
            without);
}

TEST(Simulate, HashDependsOnStepAndIntegrator) {
  const std::string scene = hash_of({"--until", "0.1"});
  EXPECT_EQ(hash_of({"--until", "0.1", "--dt", "0.001"}), scene);
  EXPECT_NE(hash_of({"--until", "0.1", "--dt", "0.0005"}), scene);
  EXPECT_EQ(hash_of({"--until", "0.1", "--integrator", "velocity_verlet"}), scene);
  EXPECT_NE(hash_of({"--until", "0.1", "--integrator", "heun"}), scene);
  EXPECT_EQ(hash_of({"--until", "0.1", "--control", "fixed"}), scene);
  EXPECT_NE(hash_of({"--until", "0.1", "--control", "adaptive"}), scene);
  EXPECT_NE(hash_of({"--until", "0.1", "--accuracy", "0.05"}), scene);
}

// Two masses m on a spring: the distance is l + a cos(w t) with w^2 = 2 k / m. Velocity Verlet's
// phase error is (w dt)^3 / 24 a step, that is t w (w dt)^2 / 24 at t.
TEST(Simulate, SpringSwingsAtItsFrequency) {
  const TemporaryFolder folder;
  const std::string file = folder.file("pair.csv");
  const ProgramResult result =
      run_vat({"simulate", test_scene("pair"), "--until", "1", "--every", "0.1", "--output", file});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Table table = read_csv(file);
  ASSERT_EQ(table.rows.size(), 2u * 11u);
  const double w = std::sqrt(200);
  const double dt = 1e-3;
  for (std::size_t row = 0; row < table.rows.size(); row += 2) {
    const double time = table.number(row, "time");
    const std::size_t output = row / 2;
    EXPECT_NEAR(time, 0.1 * static_cast<double>(output), 1e-12);
    const double distance = table.number(row + 1, "x") - table.number(row, "x");
    const double bound = 0.1 * (time * w + 1) * w * w * dt * dt / 12;
    EXPECT_NEAR(distance, 1 + 0.1 * std::cos(w * time), bound) << "t = " << time;
  }
}

TEST(Simulate, OutputsAtEveryMultipleAndTheEnd) {
  const TemporaryFolder folder;
  const std::string file = folder.file("d.csv");
  const ProgramResult result = run_vat(
      {"simulate", test_scene("pair"), "--until", "0.1", "--every", "0.03", "--diagnostics", file});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Table table = read_csv(file);
  std::vector<double> times;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    times.push_back(table.number(row, "time"));
  }
  EXPECT_THAT(times, testing::Pointwise(testing::DoubleNear(1e-12),
                                        std::vector<double>{0, 0.03, 0.06, 0.09, 0.1}));
  EXPECT_THAT(lines_of(result.err), ElementsAre(HasSubstr("0.1 s simulated in 100 steps")));
}

TEST(Simulate, ShortensTheStepToFitTheOutputInterval) {
  const TemporaryFolder folder;
  const std::string file = folder.file("d.csv");
  const ProgramResult result = run_vat({"simulate", test_scene("pair"), "--until", "0.006",
                                        "--every", "0.0015", "--diagnostics", file});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("the step is 0.00075 s instead of 0.001 s"));
  EXPECT_THAT(result.err, HasSubstr("in 8 steps"));
  EXPECT_EQ(read_csv(file).rows.size(), 5u);
}

TEST(Simulate, ShortensTheStepToMeetTheEnd) {
  const ProgramResult result =
      run_vat({"simulate", test_scene("pair"), "--dt", "0.003", "--until", "0.05"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("the step is 0.0025 s instead of 0.003 s"));
  EXPECT_THAT(lines_of(result.err).back(), StartsWith("0.05 s simulated in 20 steps"));
}

TEST(Simulate, RoundsAnOddEndToWholeSteps) {
  const ProgramResult result = run_vat({"simulate", test_scene("pair"), "--until", "0.0100007"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("the run ends at 0.01 s instead of 0.0100007 s"));
}

TEST(Simulate, WarnsOfTheIntegratorInUse) {
  const auto first_line = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"simulate", test_scene("pair"), "--until", "0"});
    return lines_of(run_vat(arguments).err).front();
  };
  EXPECT_THAT(first_line({}), HasSubstr("s simulated"));
  EXPECT_THAT(first_line({"--integrator", "heun"}), StartsWith("warning: /numerics/step: "));
}

TEST(Simulate, PlanAloneDoesNotRun) {
  const ProgramResult plan = run_vat({"simulate", test_scene("mixed"), "--plan"});
  ASSERT_EQ(plan.exit_code, 0) << plan.err;
  EXPECT_THAT(plan.out, Not(IsEmpty()));
  EXPECT_THAT(plan.err, IsEmpty());
  const ProgramResult both =
      run_vat({"simulate", test_scene("mixed"), "--plan", "--hash", "--until", "0.02"});
  EXPECT_THAT(both.out, testing::StartsWith(plan.out));
  EXPECT_THAT(lines_of(both.out).back(), MatchesRegex("hash [0-9a-f]{16} [a-z0-9]+"));
}

TEST(Simulate, ProfileNamesTheStagesOfThePlan) {
  const ProgramResult plan = run_vat({"simulate", test_scene("mixed"), "--plan"});
  const ProgramResult result =
      run_vat({"simulate", test_scene("mixed"), "--profile", "--until", "0.1"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("ms per step: "));
  EXPECT_THAT(result.out, HasSubstr("real-time factor: "));
  std::map<std::string, double> shares;
  for (const std::string& line : lines_of(result.out)) {
    if (!line.ends_with(" %")) continue;
    const std::string percent = line.substr(0, line.size() - 2);
    shares[line.substr(0, line.find("  "))] = parse_number(percent.substr(percent.rfind(' ') + 1));
  }
  for (const std::string& line : lines_of(plan.out)) {
    if (line.starts_with(' ')) continue;
    EXPECT_TRUE(shares.contains(line)) << line;
  }
  EXPECT_TRUE(shares.contains("(between stages)"));
  double sum = 0;
  for (const auto& [stage, share] : shares) sum += share;
  EXPECT_NEAR(sum, 100, 0.05 * static_cast<double>(shares.size()));  // each is rounded to 0.1
}

TEST(Simulate, AnArrayHoldsNoChangingNumberOfParticles) {
  const TemporaryFolder folder;
  const ProgramResult result = run_vat({"simulate", VAT_SOURCE_DIR "/protocol/scenes/pour.json",
                                        "--until", "0.1", "--output", folder.file("run.npy")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("changing number of particles"));
}

TEST(Simulate, GuardFailureNamesBodyAndKeepsThePartialFile) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_vat({"simulate", test_scene("unstable"), "--until", "1", "--hash", "--output",
               folder.file("run.csv"), "--diagnostics", folder.file("d.csv")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(lines_of(result.err).back(),
              MatchesRegex("/bodies/1: a step failed \\(.*\\) at particle [01] of body "
                           "'wild', at t = [0-9.e-]+ s with a step of .*"));
  EXPECT_THAT(folder.names(), ElementsAre("d.csv.part", "run.csv.part"));
  EXPECT_EQ(read_csv(folder.file("run.csv.part")).rows.size() % 3, 0u);
}

}  // namespace
}  // namespace vat::test::simulate_test
