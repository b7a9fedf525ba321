#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "tests/unit/scene_json_cases.h"

namespace vat {
namespace {

constexpr const char* kFolder = VAT_SOURCE_DIR "/tests/golden/errors/";

using CodeAndPath = std::pair<std::string, std::string>;

TEST(SceneMistakes, OneFileTellsAllOfThemAtOnceAndNothingElse) {
  std::ifstream file(std::string(kFolder) + "thirty-mistakes.errors.json");
  std::multiset<CodeAndPath> expected;
  for (const Json& error : Json::parse(file)) expected.emplace(error["code"], error["path"]);
  ASSERT_GE(expected.size(), 30U);

  const Result<Scene> scene = read_scene_file(std::string(kFolder) + "thirty-mistakes.json");
  ASSERT_FALSE(scene.ok());
  std::multiset<CodeAndPath> found;
  for (const Error& error : scene.errors()) {
    found.emplace(error.code, error.path);
    EXPECT_GT(error.message.size(), 10U) << error.path;
  }
  EXPECT_EQ(found, expected);
}

/// Each mistake is refused on its own account: with the others gone, it is still there.
TEST(SceneMistakes, EachIsRefusedAlone) {
  std::ifstream file(std::string(kFolder) + "thirty-mistakes.json");
  const Json document = Json::parse(file);
  std::size_t refused = 0;
  for (std::size_t i = 0; i < document["bodies"].size(); ++i) {
    const Json scene = {{"format", "vat.scene/1"},
                        {"materials", {document["materials"][0], document["materials"][1]}},
                        {"vat", {{"min", {0, 0, 0}}, {"max", {1, 1, 1}}}},
                        {"bodies", {document["bodies"][i]}}};
    const Result<Scene> read = read_scene(scene, meshes_in_folder(kFolder));
    if (read.ok()) {
      // The only one that needs its neighbour.
      EXPECT_EQ(document["bodies"][i]["name"], "outside the vat");
      continue;
    }
    EXPECT_EQ(read.errors().size(), 1U) << scene_cases::lines(read);
    ++refused;
  }
  EXPECT_EQ(refused + 1, document["bodies"].size());
}

}  // namespace
}  // namespace vat
