#include <gtest/gtest.h>

#include <fstream>

#include "tests/protocol/scene/scene_json_cases.h"

namespace vat::scene_rules_test {
namespace {

using namespace scene_cases;

/// A valid scene, and changes that each violate one rule.
class SceneRules : public testing::TestWithParam<const char*> {
 protected:
  const Json golden_ = [] {
    std::ifstream file(std::string(VAT_SOURCE_DIR "/tests/golden/errors/") + GetParam());
    return Json::parse(file);
  }();
};

/// Applies changes. `changes` contains the new values by JSON pointer.
Json with_changes(Json scene, const Json& changes) {
  for (const auto& [pointer, value] : changes.items()) {
    scene[Json::json_pointer(pointer)] = value;
  }
  return scene;
}

TEST_P(SceneRules, TheSceneItselfIsFine) {
  EXPECT_EQ(lines(read_scene(golden_["scene"], no_meshes)), "");
}

TEST_P(SceneRules, EachMistakeHasItsOneError) {
  ASSERT_GE(golden_["mistakes"].size(), 20U);
  for (const Json& mistake : golden_["mistakes"]) {
    const Result<Scene> scene =
        read_scene(with_changes(golden_["scene"], mistake["change"]), no_meshes);
    EXPECT_EQ(lines(scene),
              mistake["code"].get<std::string>() + ' ' + mistake["path"].get<std::string>() + '\n')
        << mistake["change"];
    ASSERT_FALSE(scene.ok());
    EXPECT_GT(scene.errors()[0].message.size(), 10U);
  }
}

INSTANTIATE_TEST_SUITE_P(Files, SceneRules, testing::Values("world-rules.json", "plane-rules.json"),
                         [](const auto& file) {
                           const std::string name = file.param;
                           return name.substr(0, name.find('-'));
                         });

}  // namespace
}  // namespace vat::scene_rules_test
