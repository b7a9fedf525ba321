#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "protocol/scene/scene_json.h"
#include "server/people/governor_points.h"
#include "tests/cli/program.h"

namespace vat::test::tune_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::StartsWith;

std::vector<std::string> tune_pair(std::vector<std::string> options) {
  options.insert(options.begin(),
                 {"tune", test_scene("pair"), "--until", "0.2", "--repetitions", "1"});
  return options;
}

TEST(Tune, PrintsTheFrontAsTableAndPlot) {
  const ProgramResult result = run_vat(tune_pair({}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, IsEmpty());
  const std::vector<std::string> lines = lines_of(result.out);
  EXPECT_THAT(lines, Contains(MatchesRegex("[0-9]+ candidates: [0-9]+ completed, [0-9]+ dropped "
                                           "early, 0 failed")));
  EXPECT_THAT(lines, Contains(MatchesRegex("error over 0.2 s of 0.2 s; noise floor: .*")));
  EXPECT_THAT(lines, Contains(MatchesRegex(" a.* (fixed|adaptive|local) ?[0-9.]*, [0-9.e-]+ ms")));
  EXPECT_THAT(lines, Contains(HasSubstr("computing time per simulated second [s]")));
}

TEST(Tune, ExhaustiveSearchCompletesEveryCandidate) {
  const ProgramResult result = run_vat(tune_pair({"--exhaustive"}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr(" completed, 0 dropped early, 0 failed"));
  EXPECT_THAT(lines_of(result.out), Contains(MatchesRegex(" .\\*.* velocity_verlet, fixed, 1 ms")));
}

TEST(Tune, WritesAChoiceThatIsValid) {
  const TemporaryFolder folder;
  const std::string before = read_file(test_scene("pair"));
  folder.write("pair.json", before);
  const std::string file = folder.file("pair.json");
  const ProgramResult result = run_vat(
      {"tune", file, "--until", "0.2", "--repetitions", "1", "--error", "1e-2", "--write", file});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(lines_of(result.out), Contains(StartsWith("chosen: ")));
  EXPECT_EQ(lines_of(result.out).back(), "written to " + file);
  EXPECT_THAT(folder.names(), ElementsAre("pair.json"));
  const std::string after = read_file(file);
  EXPECT_NE(after, before);
  const auto without_numerics = [](std::string text) {
    const std::size_t begin = text.find("\"numerics\"");
    return text.erase(begin, text.find('}', begin) - begin);
  };
  EXPECT_EQ(without_numerics(after), without_numerics(before));
  EXPECT_EQ(run_vat({"validate", file}).exit_code, 0);
  EXPECT_GT(read_scene_file(file).value().numerics.step, 0.001);
}

// In runs of 5 s, the choice is Runge-Kutta 4. Other integrators are faster.
TEST(Tune, WritesTheChoiceAndCheaperPointsForTheGovernor) {
  const TemporaryFolder folder;
  const std::string file = folder.file("front.json");
  const ProgramResult result = run_vat({"tune", test_scene("pair"), "--until", "5", "--error",
                                        "2e-3", "--exhaustive", "--front", file});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(lines_of(result.out).back(), EndsWith(" points for the governor written to " + file));
  const Json params = Json::parse(read_file(file));
  Errors errors;
  ObjectReader reader(params, "", errors);
  const std::vector<GovernorPoint> points = read_governor_points(reader, "governor", errors);
  reader.refuse_unknown();
  EXPECT_THAT(errors, IsEmpty());
  ASSERT_GE(points.size(), 2u);
  EXPECT_EQ(points.front().numerics.integrator, IntegratorId::runge_kutta_4);
  EXPECT_LE(points.front().error, 2e-3);
  EXPECT_GT(points.back().error, 2e-3);
}

TEST(Tune, AFrontWithoutCheaperPointsFails) {
  const TemporaryFolder folder;
  EXPECT_THAT(run_vat(tune_pair({"--error", "1", "--front", folder.file("front.json")})),
              exits(1, HasSubstr("no completed candidate of the same solver is faster")));
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(Tune, ChoosesForRealTime) {
  const ProgramResult result = run_vat(tune_pair({"--real-time"}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(lines_of(result.out).back(), StartsWith("chosen: "));
}

TEST(Tune, UnreachedErrorsFailAndWriteNothing) {
  const TemporaryFolder folder;
  EXPECT_THAT(run_vat(tune_pair({"--error", "1e-9", "--write", folder.file("out.json")})),
              exits(1, HasSubstr("no candidate has an error of at most 1e-09")));
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(Tune, MissingMeshesFailBeforeTheRuns) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_vat({"tune", "paddle-wheel", "--error", "0.1", "--write", folder.file("out.json")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, StartsWith("/bodies/2/shape/file: "));
  EXPECT_THAT(result.out, IsEmpty());
}

TEST(Tune, InterruptedRunsWriteNothing) {
  const TemporaryFolder folder;
  RunningProgram program({"tune", test_scene("mixed"), "--until", "1000", "--error", "0.1",
                          "--write", folder.file("out.json")});
  ASSERT_TRUE(program.wait_for_output("measuring runs of 1000 s"));
  program.send(SIGINT);
  const ProgramResult result = program.finish();
  EXPECT_EQ(result.exit_code, 128 + SIGINT);
  EXPECT_THAT(result.err, HasSubstr("interrupted"));
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(Tune, BenchComparesTheChoicesWithAnExhaustiveSearch) {
  const TemporaryFolder folder;
  const ProgramResult result = run_bench(
      {"tune", "--case", "rigid-stack", "--until", "0.02", "--output", folder.file("results")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(
      lines_of(read_file(folder.file("results") + "/tune.csv")),
      ElementsAre(StartsWith("scene,candidates,dropped,front,"), StartsWith("rigid-stack,47,")));
}

TEST(Tune, RefusesWrongOptions) {
  for (const auto& [options, named] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--write", "out.json"}, "--error or --real-time"},
           {{"--front", "out.json"}, "--error or --real-time"},
           {{"--error", "0.1", "--front", "out.txt"}, "must end in .json"},
           {{"--error", "0.1", "--write", "out.txt"}, "must end in .json"},
           {{"--error", "0.1", "--real-time"}, "excludes"},
           {{"--error", "0"}, "--error"},
           {{"--until", "2000"}, "--until"},
           {{"--repetitions", "0"}, "--repetitions"}}) {
    EXPECT_THAT(run_vat(tune_pair(options)), exits(2, HasSubstr(named)));
  }
  const ProgramResult broken = run_vat({"tune", test_scene("broken")});
  EXPECT_EQ(broken.exit_code, 1);
  EXPECT_THAT(broken.err, HasSubstr("/numerics/step"));
}

}  // namespace
}  // namespace vat::test::tune_test
