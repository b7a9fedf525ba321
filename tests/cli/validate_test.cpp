#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "tests/cli/program.h"

namespace vat::test::validate_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

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
}  // namespace vat::test::validate_test
