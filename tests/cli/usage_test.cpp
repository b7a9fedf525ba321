#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "tests/cli/program.h"

namespace vat::test::usage_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::StartsWith;

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

/// Wrong uses, and a text in the message of each.
using WrongUses = std::vector<std::pair<std::string, std::string>>;

/// `before` precedes each use.
void expect_wrong(const std::vector<std::string>& before, const WrongUses& uses) {
  for (const auto& [line, named] : uses) {
    std::vector<std::string> words = before;
    std::ranges::copy(words_of(line), std::back_inserter(words));
    const ProgramResult result = run_vat(words);
    EXPECT_THAT(result, exits(2, HasSubstr(named))) << line;
    EXPECT_THAT(result.out, IsEmpty()) << line;
  }
}

TEST(WrongUsage, OfCommandsIsNamed) {
  expect_wrong({}, {{"", "subcommand"},
                    {"conquer", "conquer"},
                    {"simulat", "Did you mean simulate?"},
                    {"simulate", "scene"},
                    {"validate", "scene"},
                    {"convert", "source"},
                    {"record", "scene"},
                    {"export", "recording"},
                    {"export none.vatrec --html a.html", "none.vatrec"}});
  expect_wrong({"serve"}, {{"--isa sse9", "baseline, avx2, avx512"},
                           {"--endpoints 0", "--endpoints"},
                           {"--port 70000", "from 0 to 65535, not '70000'"},
                           {"--host localhost", "a numeric address"},
                           {"--log-level loud", "debug, info, warn, error or off"},
                           {"--max-connections 0", "--max-connections"},
                           {"--max-clients 1000000", "--max-clients"}});
}

TEST(WrongUsage, OfNumbersNamesTheOption) {
  const std::pair<const char*, const char*> cases[] = {
      {"--until", "-1 nan 1e400 soon"},
      {"--every", "0 inf"},
      {"--dt", "0 0.2 1e-400"},
      {"--threads", "0 1.5 -1 99999999999999999999"},
      {"--integrator", "magic 7"},
      {"--control", "loose"},
      {"--accuracy", "1"}};
  for (const auto& [option, values] : cases) {
    for (const std::string& value : words_of(values)) {
      expect_wrong({"simulate", test_scene("pair")}, {{option + (' ' + value), option}});
    }
  }
}

TEST(WrongUsage, OfASimulationIsNamed) {
  expect_wrong({"simulate", test_scene("pair")},
               {{"--leval=fine", "Did you mean --level?"},
                {"--level corse", "did you mean \"coarse\"?"},
                {"--integrator heum", "did you mean \"heun\"?"},
                {"--integrator heum",
                 "explicit_euler, heun, runge_kutta_4, symplectic_euler, velocity_verlet"},
                {"--isa avx", "did you mean \"avx2\"?"},
                {"--isa avx", "baseline, avx2, avx512"},
                {"--speed 2", "--speed"},
                {"--until", "--until"},
                {"--device gpu", "cpu, auto, opencl, opencl:N"},
                {"--accuracy 1e-3 --dt 0.001", "--accuracy"},
                {"--output run.xyz", ".npz, .glb or .abc"},
                {"--output run", ".npz, .glb or .abc"},
                {"--output run.pvd --surface", ".glb or .abc"},
                {"--diagnostics run.txt", "must end in .csv"},
                {"--diagnostics scene.json", "must end in .csv"},
                {"--output a.csv --diagnostics ./a.csv", "must not be the file of --output"},
                {"another.json", "another.json"}});
}

TEST(WrongUsage, OfRecordingsIsNamed) {
  expect_wrong({"export", test_scene("pair")}, {{"--html a.txt", "must end in .html"}});
  expect_wrong({"record", test_scene("pair")}, {{"", "--output"},
                                                {"--output a.csv", "must end in .vatrec"},
                                                {"--output a.vatrec --until 2e6", "--until"},
                                                {"--output a.vatrec --every 0", "--every"},
                                                {"--output a.vatrec --max-error -1", "--max-error"},
                                                {"--output a.vatrec --key-every 0", "--key-every"},
                                                {"--output a.vatrec --threads 0", "--threads"}});
}

TEST(Usage, VersionIsPrinted) {
  const ProgramResult result = run_vat({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, MatchesRegex("vat [0-9]+\\.[0-9]+\\.[0-9]+ \\((commit [0-9a-f]+; )?"
                                       "instruction sets baseline[a-z0-9, ]*\\)\n"));
}

TEST(Usage, CompletionsArePrinted) {
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"re"}, "replay\nrecord\nrestore\n"},
      {{"complet"}, ""},  // the shell's own command
      {{"--ver"}, "--version\n"},
      {{"none", ""}, ""},
      {{"simulate", "--un"}, "--until\n"},
      {{"simulate", "tilt"}, "tilted-floor\n"},
      {{"simulate", "--hash", "tilt"}, "tilted-floor\n"},
      {{"serve", "--scene", "tilt"}, "tilted-floor\n"},
      {{"serve", "tilt"}, ""},  // serve has no positional argument
      {{"simulate", "--level", "fin"}, "fine\nfinest\n"},
      {{"simulate", "--until", ""}, ""},
      {{"validate", "--scenes", VAT_SOURCE_DIR "/tests/cli/scenes", "pair"}, "pair\n"}};
  for (const auto& [words, expected] : cases) {
    std::vector<std::string> arguments = {"complete", "--"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const ProgramResult result = run_vat(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, expected) << testing::PrintToString(words);
  }
}

TEST(Usage, HelpDescribesTheOutputFiles) {
  const ProgramResult result = run_vat({"simulate", "--help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* text :
       {".csv", ".pvd", ".npz", ".abc", "--every", "velocity_verlet", "2 wrong"}) {
    EXPECT_THAT(result.out, HasSubstr(text));
  }
}

// The request is within the options' ranges, but the resulting step is not.
TEST(Usage, StepThatIsTooShortIsExplained) {
  const ProgramResult result = run_vat(
      {"simulate", test_scene("pair"), "--dt", "1e-7", "--every", "1.5e-7", "--until", "1.5e-6"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(lines_of(result.err),
              ElementsAre(testing::StartsWith("the step is 7.5e-08 s instead of 1e-07 s"),
                          testing::StartsWith("/numerics/step: must be")));
}

TEST(Usage, UnknownSceneListsTheCatalogue) {
  for (const char* command : {"simulate", "validate"}) {
    const ProgramResult result = run_vat({command, "atlantis"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("atlantis: is not in the catalogue, which has"));
    EXPECT_THAT(result.err, HasSubstr("dam-break"));
  }
}

TEST(Usage, SceneFolderCanBeChosen) {
  const std::string folder = VAT_SOURCE_DIR "/tests/cli/scenes";
  EXPECT_EQ(run_vat({"validate", "pair", "--scenes", folder}).exit_code, 0);
  using Words = std::vector<std::string>;
  for (const Words& command : {Words{"validate", "pair"}, Words{"serve"}}) {
    Words words = command;
    words.insert(words.end(), {"--scenes", folder + "/none"});
    const ProgramResult missing = run_vat(words);
    EXPECT_EQ(missing.exit_code, 1);
    EXPECT_EQ(missing.err,
              folder + "/none: the scenes cannot be listed: No such file or directory\n");
  }
}

TEST(Usage, UnreadableScenesAreErrors) {
  const TemporaryFolder folder;
  const std::string missing = folder.file("none.json");
  EXPECT_THAT(run_vat({"simulate", missing}), exits(1, HasSubstr(missing + ": does not exist")));
  EXPECT_THAT(run_vat({"simulate", folder.file("")}), exits(1, HasSubstr(": is not a file")));
}

std::set<std::string> paths_of(const std::string& errors) {
  std::set<std::string> paths;
  for (const std::string& line : lines_of(errors)) paths.insert(line.substr(0, line.find(": ")));
  return paths;
}

TEST(Validate, ValidSceneIsSummarised) {
  const ProgramResult result = run_vat({"validate", test_scene("pair")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, HasSubstr("valid; bodies: 1, particles: 2, springs: 1, steps per tick: "
                                    "20 of 0.001 s (velocity_verlet)"));
}

TEST(Validate, EveryErrorHasItsPath) {
  for (const char* command : {"validate", "simulate"}) {
    const ProgramResult result = run_vat({command, test_scene("broken")});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_THAT(paths_of(result.err), ElementsAre("/bodies/0/kind", "/colour", "/gravity",
                                                  "/materials/0/density", "/numerics/step"));
  }
}

TEST(Validate, WarningsAreMarkedAndAllowed) {
  const ProgramResult result = run_vat({"validate", test_scene("overlapping")});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(lines_of(result.err), Contains(StartsWith("warning: /bodies/")));
  EXPECT_THAT(result.out, HasSubstr("valid; bodies: 2"));
}

TEST(Validate, TextThatIsNoJsonIsAnErrorOfTheFile) {
  const TemporaryFolder folder;
  const std::string file = folder.file("scene.json");
  std::ofstream(file) << "{\"format\": ";
  const ProgramResult result = run_vat({"validate", file});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(lines_of(result.err), ElementsAre(StartsWith(file + ": ")));
}

}  // namespace
}  // namespace vat::test::usage_test
