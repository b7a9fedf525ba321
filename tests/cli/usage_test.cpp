#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <ostream>
#include <set>

#include "tests/cli/program.h"

namespace vat::test::usage_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::StartsWith;

struct WrongUse {
  std::vector<std::string> arguments;
  std::string named;  ///< text in the message
};

/// Prints the arguments in the test's name, with scenes as file names.
void PrintTo(const WrongUse& use, std::ostream* out) {
  *out << "vat";
  for (const std::string& argument : use.arguments) {
    *out << ' ' << argument.substr(argument.rfind('/') + 1);
  }
}

class WrongUsage : public testing::TestWithParam<WrongUse> {};

TEST_P(WrongUsage, ExitsWithTwoAndNamesTheCause) {
  const ProgramResult result = run_vat(GetParam().arguments);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, HasSubstr(GetParam().named));
}

std::vector<std::string> with_scene(std::vector<std::string> options) {
  options.insert(options.begin(), {"simulate", test_scene("pair")});
  return options;
}

INSTANTIATE_TEST_SUITE_P(
    Usage, WrongUsage,
    testing::Values(WrongUse{{}, "subcommand"}, WrongUse{{"conquer"}, "conquer"},
                    WrongUse{{"simulat"}, "Did you mean simulate?"},
                    WrongUse{with_scene({"--leval=fine"}), "Did you mean --level?"},
                    WrongUse{with_scene({"--level", "corse"}), "did you mean \"coarse\"?"},
                    WrongUse{with_scene({"--integrator", "heum"}), "did you mean \"heun\"?"},
                    WrongUse{with_scene({"--isa", "avx"}), "did you mean \"avx2\"?"},
                    WrongUse{{"simulate"}, "scene"}, WrongUse{{"validate"}, "scene"},
                    WrongUse{{"convert"}, "source"},
                    WrongUse{with_scene({"--speed", "2"}), "--speed"},
                    WrongUse{with_scene({"--until", "-1"}), "--until"},
                    WrongUse{with_scene({"--until", "nan"}), "--until"},
                    WrongUse{with_scene({"--until", "1e400"}), "--until"},
                    WrongUse{with_scene({"--until", "soon"}), "--until"},
                    WrongUse{with_scene({"--every", "0"}), "--every"},
                    WrongUse{with_scene({"--dt", "0"}), "--dt"},
                    WrongUse{with_scene({"--dt", "0.2"}), "--dt"},
                    WrongUse{with_scene({"--threads", "0"}), "--threads"},
                    WrongUse{with_scene({"--threads", "1.5"}), "--threads"},
                    WrongUse{with_scene({"--threads", "-1"}), "--threads"},
                    WrongUse{with_scene({"--isa", "avx"}), "baseline, avx2, avx512"},
                    WrongUse{with_scene({"--device", "gpu"}), "cpu, auto, opencl, opencl:N"},
                    WrongUse{{"serve", "--isa", "sse9"}, "baseline, avx2, avx512"},
                    WrongUse{{"serve", "--endpoints", "0"}, "--endpoints"},
                    WrongUse{{"serve", "--port", "70000"}, "from 0 to 65535, not '70000'"},
                    WrongUse{{"serve", "--host", "localhost"}, "a numeric address"},
                    WrongUse{{"serve", "--log-level", "loud"}, "debug, info, warn, error or off"},
                    WrongUse{{"serve", "--max-connections", "0"}, "--max-connections"},
                    WrongUse{{"serve", "--max-clients", "1000000"}, "--max-clients"},
                    WrongUse{with_scene({"--integrator", "magic"}), "--integrator"},
                    WrongUse{with_scene({"--integrator", "7"}), "--integrator"},
                    WrongUse{with_scene({"--control", "loose"}), "--control"},
                    WrongUse{with_scene({"--accuracy", "1"}), "--accuracy"},
                    WrongUse{with_scene({"--accuracy", "1e-3", "--dt", "0.001"}), "--accuracy"},
                    WrongUse{with_scene({"--output", "run.xyz"}), ".npz, .glb or .abc"},
                    WrongUse{with_scene({"--output", "run"}), ".npz, .glb or .abc"},
                    WrongUse{with_scene({"--output", "run.pvd", "--surface"}), ".glb or .abc"},
                    WrongUse{with_scene({"--diagnostics", "run.txt"}), "must end in .csv"},
                    WrongUse{with_scene({"--diagnostics", "scene.json"}), "must end in .csv"},
                    WrongUse{with_scene({"--output", "a.csv", "--diagnostics", "./a.csv"}),
                             "must not be the file of --output"},
                    WrongUse{with_scene({"--threads", "99999999999999999999"}), "--threads"},
                    WrongUse{with_scene({"--dt", "1e-400"}), "--dt"},
                    WrongUse{with_scene({"--every", "inf"}), "--every"},
                    WrongUse{with_scene({"another.json"}), "another.json"},
                    WrongUse{with_scene({"--until"}), "--until"}));

std::vector<std::string> record_with(std::vector<std::string> options) {
  options.insert(options.begin(), {"record", test_scene("pair"), "--output", "a.vatrec"});
  return options;
}

INSTANTIATE_TEST_SUITE_P(
    Recordings, WrongUsage,
    testing::Values(
        WrongUse{{"record"}, "scene"}, WrongUse{{"record", test_scene("pair")}, "--output"},
        WrongUse{{"record", test_scene("pair"), "--output", "a.csv"}, "must end in .vatrec"},
        WrongUse{record_with({"--until", "2e6"}), "--until"},
        WrongUse{record_with({"--every", "0"}), "--every"},
        WrongUse{record_with({"--max-error", "-1"}), "--max-error"},
        WrongUse{record_with({"--key-every", "0"}), "--key-every"},
        WrongUse{record_with({"--threads", "0"}), "--threads"}, WrongUse{{"export"}, "recording"},
        WrongUse{{"export", "none.vatrec", "--html", "a.html"}, "none.vatrec"},
        WrongUse{{"export", test_scene("pair"), "--html", "a.txt"}, "must end in .html"}));

TEST(Usage, VersionIsPrinted) {
  const ProgramResult result = run_vat({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, MatchesRegex("vat [0-9]+\\.[0-9]+\\.[0-9]+ \\((commit [0-9a-f]+; )?"
                                       "instruction sets baseline[a-z0-9, ]*\\)\n"));
}

struct Completion {
  std::vector<std::string> words;  // the last one is incomplete
  std::string expected;
};

void PrintTo(const Completion& completion, std::ostream* out) {
  PrintTo(WrongUse{completion.words, ""}, out);
}

class Completions : public testing::TestWithParam<Completion> {};

TEST_P(Completions, ArePrinted) {
  std::vector<std::string> arguments = {"complete", "--"};
  arguments.insert(arguments.end(), GetParam().words.begin(), GetParam().words.end());
  const ProgramResult result = run_vat(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(
    OfThe, Completions,
    testing::Values(Completion{{"re"}, "replay\nrecord\nrestore\n"},
                    Completion{{"complet"}, ""},  // the shell's own command
                    Completion{{"--ver"}, "--version\n"}, Completion{{"none", ""}, ""},
                    Completion{{"simulate", "--un"}, "--until\n"},
                    Completion{{"simulate", "tilt"}, "tilted-floor\n"},
                    Completion{{"simulate", "--hash", "tilt"}, "tilted-floor\n"},
                    Completion{{"serve", "--scene", "tilt"}, "tilted-floor\n"},
                    Completion{{"serve", "tilt"}, ""},  // serve has no positional argument
                    Completion{{"simulate", "--level", "fin"}, "fine\nfinest\n"},
                    Completion{{"simulate", "--until", ""}, ""},
                    Completion{{"validate", "--scenes", VAT_SOURCE_DIR "/tests/cli/scenes", "pair"},
                               "pair\n"}));

TEST(Usage, HelpDescribesTheOutputFiles) {
  const ProgramResult result = run_vat({"simulate", "--help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* text :
       {".csv", ".pvd", ".npz", ".abc", "--every", "velocity_verlet", "2 wrong"}) {
    EXPECT_THAT(result.out, HasSubstr(text));
  }
}

TEST(Usage, AllIntegratorsAreAccepted) {
  for (const char* name :
       {"explicit_euler", "symplectic_euler", "velocity_verlet", "heun", "runge_kutta_4"}) {
    const ProgramResult result =
        run_vat({"simulate", test_scene("pair"), "--until", "0.02", "--integrator", name});
    EXPECT_EQ(result.exit_code, 0) << result.err;
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
  const ProgramResult none = run_vat({"simulate", missing});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr(missing + ": does not exist"));
  const ProgramResult a_folder = run_vat({"simulate", folder.file("")});
  EXPECT_EQ(a_folder.exit_code, 1);
  EXPECT_THAT(a_folder.err, HasSubstr(": is not a file"));
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
