#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace vat::test::convert_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

std::string foreign_scene(const std::string& name) {
  return VAT_SOURCE_DIR "/tests/protocol/convert/scenes/" + name + ".json";
}

TEST(Convert, WritesScenesThatRun) {
  const TemporaryFolder folder;
  const std::string scene = folder.file("scene.json");
  for (const char* name : {"dam_break", "obstacle", "emitter"}) {
    const ProgramResult converted = run_vat({"convert", foreign_scene(name), scene});
    ASSERT_EQ(converted.exit_code, 0) << converted.err;
    EXPECT_EQ(converted.out, "");
    const ProgramResult valid = run_vat({"validate", scene});
    EXPECT_EQ(valid.exit_code, 0) << valid.err;
    const ProgramResult simulated = run_vat({"simulate", scene, "--until", "0.1"});
    EXPECT_EQ(simulated.exit_code, 0) << name << simulated.err;
    EXPECT_THAT(simulated.err, HasSubstr("guard events: 0")) << name;
  }
}

TEST(Convert, PrintsTheSceneAndWhatItOmits) {
  const TemporaryFolder folder;
  const std::string scene = folder.file("scene.json");
  const ProgramResult printed = run_vat({"convert", foreign_scene("emitter")});
  const ProgramResult written = run_vat({"convert", foreign_scene("emitter"), scene});
  EXPECT_EQ(printed.exit_code, 0);
  EXPECT_EQ(printed.out, read_file(scene));
  EXPECT_EQ(printed.err, written.err);
  EXPECT_THAT(lines_of(printed.err),
              Contains("omitted: /Materials/0/emitterReuseParticles: particles are not reused; "
                       "drains can remove particles"));
}

TEST(Convert, ReportsEveryErrorAndWritesNothing) {
  const TemporaryFolder folder;
  folder.write("bad.json", R"({"Configuration": {"particleRadius": 0, "sim2D": "no"}})");
  const ProgramResult bad = run_vat({"convert", folder.file("bad.json"), folder.file("out.json")});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(lines_of(bad.err), ElementsAre(StartsWith("/Configuration/sim2D: must be true"),
                                             StartsWith("/Configuration/particleRadius: must be")));
  EXPECT_THAT(folder.names(), ElementsAre("bad.json"));
  folder.write("text.json", "{");
  const ProgramResult text = run_vat({"convert", folder.file("text.json")});
  EXPECT_EQ(text.exit_code, 1);
  EXPECT_THAT(text.err, StartsWith(folder.file("text.json") + ": "));
  EXPECT_EQ(text.out, "");
}

TEST(Convert, RefusesWrongFiles) {
  const std::string scene = foreign_scene("emitter");
  for (const auto& arguments :
       {std::vector<std::string>{"convert"}, {"convert", "none.json"}, {"convert", scene, "out"}}) {
    EXPECT_EQ(run_vat(arguments).exit_code, 2);
  }
  EXPECT_THAT(run_vat({"convert", scene, scene}),
              exits(2, HasSubstr("must not be the converted file")));
}

}  // namespace
}  // namespace vat::test::convert_test
