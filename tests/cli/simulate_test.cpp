#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "core/limits.h"
#include "server/cli/simulate/simulate_schedule.h"
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

// The start of each catalogue scene.
TEST(Simulate, CatalogueScenesAreTheSameForAnyThreadCount) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(VAT_SOURCE_DIR "/protocol/scenes")) {
    if (entry.path().extension() != ".json") continue;
    const std::string scene = entry.path();
    const std::string one = hash_of(scene, {"--until", "0.1", "--threads", "1"});
    EXPECT_EQ(hash_of(scene, {"--until", "0.1", "--threads", "4"}), one) << scene;
    ++count;
  }
  EXPECT_GE(count, 6u);
}

TEST(Simulate, TakesALevelOfDetail) {
  const std::string scene = VAT_SOURCE_DIR "/protocol/scenes/dam-break.json";
  const std::string normal = hash_of(scene, {"--until", "0.02"});
  EXPECT_EQ(hash_of(scene, {"--until", "0.02", "--level", "normal"}), normal);
  EXPECT_NE(hash_of(scene, {"--until", "0.02", "--level", "coarse"}), normal);
  EXPECT_THAT(
      run_vat({"simulate", VAT_SOURCE_DIR "/protocol/scenes/tilted-floor.json", "--level", "fine"}),
      exits(1, HasSubstr("/shape/type")));
}

TEST(Simulate, HashDoesNotDependOnOutputs) {
  const TemporaryFolder folder;
  const std::string without = hash_of({"--until", "0.2"});
  EXPECT_EQ(hash_of({"--until", "0.2", "--every", "0.007"}), without);
  EXPECT_EQ(hash_of({"--until", "0.2", "--every", "5"}), without);
  EXPECT_EQ(hash_of({"--until", "0.2", "--output", folder.file("a.pvd"), "--diagnostics",
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

TEST(Simulate, ReportsDeparturesFromTheOptions) {
  using Words = std::vector<std::string>;
  const std::pair<Words, const char*> cases[] = {
      {{"--until", "0.006", "--every", "0.0015"}, "the step is 0.00075 s instead of 0.001 s"},
      {{"--until", "0.0100007"}, "the run ends at 0.01 s instead of 0.0100007 s"}};
  for (const auto& [options, notice] : cases) {
    Words words = {"simulate", test_scene("pair")};
    words.insert(words.end(), options.begin(), options.end());
    EXPECT_THAT(run_vat(words), exits(0, HasSubstr(notice)));
  }
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

TEST(Schedule, KeepsAStepThatDividesTheInterval) {
  for (const Real step : {1e-3, 1.0 / 3000, 0.0001, 0.007}) {
    for (const int count : {1, 3, 10, 12345}) {
      const Schedule schedule = make_schedule(step, step * count, step * count * 2);
      EXPECT_EQ(schedule.step, step);
      EXPECT_EQ(schedule.steps_per_output, static_cast<std::uint64_t>(count));
      EXPECT_EQ(schedule.output_count(), 3u);
      EXPECT_TRUE(schedule.notices.empty());
    }
  }
}

TEST(Schedule, NeverLengthensTheStep) {
  for (const Real every : {0.00999, 0.0101, 0.5, 0.0005, 1e-6}) {
    const Schedule schedule = make_schedule(1e-3, every, 0);
    EXPECT_LE(schedule.step, 1e-3) << every;
    EXPECT_DOUBLE_EQ(schedule.step * static_cast<Real>(schedule.steps_per_output), every);
  }
}

TEST(Schedule, ShortensTheStepUntilItMeetsTheEndToo) {
  struct Case {
    Real every, until, step;
  };
  for (const Case& c : {Case{0.3, 1, 0.1 / 100}, Case{0.02, 0.0505, 0.0005},
                        Case{0.007, 0.01, 0.001}, Case{0.0104, 0.02, 0.0008}}) {
    const Schedule schedule = make_schedule(1e-3, c.every, c.until);
    EXPECT_DOUBLE_EQ(schedule.step, c.step) << c.every << ' ' << c.until;
    EXPECT_DOUBLE_EQ(schedule.step * static_cast<Real>(schedule.total_steps), c.until);
  }
}

TEST(Schedule, CountsTheOutputAtTheEndOnce) {
  EXPECT_EQ(make_schedule(0.1, 0.2, 0).output_count(), 1u);
  EXPECT_EQ(make_schedule(0.1, 0.2, 0.1).output_count(), 2u);
  EXPECT_EQ(make_schedule(0.1, 0.2, 0.2).output_count(), 2u);
  EXPECT_EQ(make_schedule(0.1, 0.2, 0.5).output_count(), 4u);
}

TEST(Schedule, TickIsKeptIfItIsAWholeNumberOfSteps) {
  const Numerics scene{.step = 1e-3, .tick = 0.02};
  EXPECT_EQ(with_step(scene, 1e-3).tick, 0.02);
  EXPECT_EQ(with_step(scene, 2e-3).tick, 0.02);
  EXPECT_DOUBLE_EQ(with_step(scene, 3e-3).tick, 0.021);
  EXPECT_DOUBLE_EQ(with_step(scene, 0.1).tick, 0.1);
  const Numerics shortest = with_step(scene, kMinStep);
  EXPECT_DOUBLE_EQ(shortest.tick, kMinStep * kMaxStepsPerTick);
}

// Compares the plan of every catalogue scene with tests/golden/plans. A change that adds
// unnecessary work to a scene is then visible in review. VAT_UPDATE_GOLDEN=1 rewrites the files.

namespace fs = std::filesystem;

const fs::path kScenes = VAT_SOURCE_DIR "/protocol/scenes";
const fs::path kPlans = VAT_SOURCE_DIR "/tests/golden/plans";

std::set<std::string> stems(const fs::path& folder, const std::string& ending) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ending) names.insert(entry.path().stem().string());
  }
  return names;
}

bool update_golden() {
  const char* value = std::getenv("VAT_UPDATE_GOLDEN");
  return value != nullptr && std::string(value) == "1";
}

TEST(Plan, CatalogueScenesKeepTheirPlans) {
  const std::set<std::string> scenes = stems(kScenes, ".json");
  ASSERT_FALSE(scenes.empty());
  for (const std::string& scene : scenes) {
    const ProgramResult result = run_vat({"simulate", scene, "--plan", "--scenes", kScenes});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const fs::path golden = kPlans / (scene + ".txt");
    if (update_golden()) {
      std::ofstream(golden) << result.out;
    } else {
      ASSERT_TRUE(fs::exists(golden)) << golden << " is missing: run with VAT_UPDATE_GOLDEN=1";
      EXPECT_EQ(result.out, read_file(golden)) << scene;
    }
  }
  EXPECT_EQ(stems(kPlans, ".txt"), scenes) << "a plan without a scene";
}

}  // namespace
}  // namespace vat::test::simulate_test
