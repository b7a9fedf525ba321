#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "tests/protocol/scene/scene_json_cases.h"

namespace vat::scene_json_mistakes_test {
namespace {

constexpr const char* kFolder = VAT_SOURCE_DIR "/tests/golden/errors/";

using CodeAndPath = std::pair<std::string, std::string>;
using Mistakes = std::multiset<CodeAndPath>;
using Pointer = Json::json_pointer;

Json golden(const std::string& name) {
  std::ifstream file(kFolder + name);
  return Json::parse(file);
}

/// Returns the errors of thirty-mistakes.json.
Mistakes all_mistakes() {
  Mistakes mistakes;
  for (const Json& error : golden("thirty-mistakes.errors.json")) {
    mistakes.emplace(error["code"], error["path"]);
  }
  return mistakes;
}

Mistakes mistakes_of(const Result<Scene>& scene) {
  Mistakes mistakes;
  if (scene.ok()) return mistakes;
  for (const Error& error : scene.errors()) mistakes.emplace(error.code, error.path);
  return mistakes;
}

/// Returns the errors at or below `part`, with their paths moved to `place`.
Mistakes moved(const Mistakes& mistakes, const std::string& part, const std::string& place) {
  Mistakes found;
  for (const auto& [code, path] : mistakes) {
    if (path == part || path.rfind(part + "/", 0) == 0) {
      found.emplace(code, place + path.substr(part.size()));
    }
  }
  return found;
}

/// Returns a valid scene with a liquid and a solid material of `document`.
Json fine_scene(const Json& document) {
  return {
      {"format", "vat.scene/1"},
      {"materials", {document["materials"][0], document["materials"][1]}},
      {"interfaces", Json::array()},
      {"vat",
       {{"min", {0, 0, 0}}, {"max", {1, 1, 1}}, {"motion", {{"type", "slide"}, {"stroke", 0.1}}}}},
      {"bodies", Json::array()}};
}

TEST(SceneMistakes, OneFileReportsAllAtOnceAndNoOthers) {
  const Mistakes expected = all_mistakes();
  ASSERT_GE(expected.size(), 30U);

  const Result<Scene> scene = read_scene_file(std::string(kFolder) + "thirty-mistakes.json");
  ASSERT_FALSE(scene.ok());
  for (const Error& error : scene.errors()) EXPECT_GT(error.message.size(), 10U) << error.path;
  EXPECT_EQ(mistakes_of(scene), expected);
}

// The invalid members do not hide errors of the others.
TEST(SceneMistakes, PartsWithInvalidMembersAreCheckedFurther) {
  const Json scene = Json::parse(R"({
    "format": "vat.scene/1",
    "materials": [
      {"name": "stone"},
      {"name": "stone", "density": -5, "liquid": {"stiffness": 100}},
      {"name": "vat", "density": "light"}],
    "bodies": [
      {"name": "a", "kind": "rigid", "material": "wood", "spacing": 0.1,
       "shape": {"type": "sphere", "radius": -1}},
      {"name": "a", "kind": "rigid", "material": "stone", "spacing": 0.1,
       "shape": {"type": "sphere", "radius": 0.2}},
      {"name": "a", "kind": "rigid", "material": "stone", "spacing": 0.1, "mass": "heavy",
       "melting": {"into": "wax", "at": 1},
       "shape": {"type": "sphere", "radius": 0.2}}]})");
  const Mistakes expected{{"duplicate", "/materials/1/name"},
                          {"out_of_range", "/materials/1/density"},
                          {"missing", "/materials/1/liquid/viscosity"},
                          {"missing", "/materials/1/liquid/support_radius"},
                          {"reserved_name", "/materials/2/name"},
                          {"wrong_type", "/materials/2/density"},
                          {"out_of_range", "/bodies/0/shape/radius"},
                          {"unknown_name", "/bodies/0/material"},
                          {"duplicate", "/bodies/1/name"},
                          {"wrong_type", "/bodies/2/mass"},
                          {"unknown_name", "/bodies/2/melting/into"},
                          {"duplicate", "/bodies/2/name"}};
  EXPECT_EQ(mistakes_of(read_scene(scene, meshes_in_folder(kFolder))), expected);
}

// The name of a material with an invalid name is unknown, so any reference may be to it.
TEST(SceneMistakes, ReferencesToPartsWithoutAValidNameAreNotErrors) {
  const Json scene = Json::parse(R"({
    "format": "vat.scene/1",
    "materials": [{"name": 5}],
    "bodies": [{"name": "a", "kind": "rigid", "material": "wood", "spacing": 0.1,
                "shape": {"type": "sphere", "radius": -1}}]})");
  const Mistakes expected{{"wrong_type", "/materials/0/name"},
                          {"out_of_range", "/bodies/0/shape/radius"}};
  EXPECT_EQ(mistakes_of(read_scene(scene, meshes_in_folder(kFolder))), expected);
}

/// Each error is detected independently: it remains if all others are removed.
class SceneMistakesAlone : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(read(fine_scene(document_)).ok()); }

  static Result<Scene> read(const Json& scene) {
    return read_scene(scene, meshes_in_folder(kFolder));
  }

  /// Inserts the invalid part into a valid scene at `place`.
  void expect_refused(const std::string& part, const std::string& place) const {
    Json scene = fine_scene(document_);
    scene[Pointer(place)] = document_[Pointer(part)];
    const Mistakes expected = moved(mistakes_, part, place);
    EXPECT_EQ(expected.size(), 1U) << part;
    EXPECT_EQ(mistakes_of(read(scene)), expected) << part;
  }

  const Json document_ = golden("thirty-mistakes.json");
  const Mistakes mistakes_ = all_mistakes();
};

TEST_F(SceneMistakesAlone, OutsideOfLists) {
  for (const char* part : {"/title", "/gravity", "/colour", "/default_interface", "/numerics",
                           "/vat/motion/axis", "/vat/motion/period"}) {
    expect_refused(part, part);
  }
}

TEST_F(SceneMistakesAlone, InLists) {
  // These repeat earlier elements of their list.
  const std::set<std::string> need_a_neighbour{"/interfaces/5", "/bodies/34"};
  std::size_t tried = 0;
  for (const std::string list : {"/materials", "/interfaces", "/bodies"}) {
    const std::string end =
        list + "/" + std::to_string(fine_scene(document_)[Pointer(list)].size());
    for (std::size_t i = 0; i < document_[Pointer(list)].size(); ++i) {
      const std::string part = list + "/" + std::to_string(i);
      if (moved(mistakes_, part, part).empty() || need_a_neighbour.count(part) > 0) continue;
      expect_refused(part, end);
      ++tried;
    }
  }
  const std::size_t outside_of_lists = 7;
  EXPECT_EQ(tried + need_a_neighbour.size() + outside_of_lists, mistakes_.size());
}

/// A valid scene, and changes that each violate one rule.
class SceneRules : public testing::TestWithParam<const char*> {
 protected:
  const Json golden_ = golden(GetParam());
};

/// Applies changes. `changes` contains the new values by JSON pointer.
Json with_changes(Json scene, const Json& changes) {
  for (const auto& [pointer, value] : changes.items()) {
    scene[Json::json_pointer(pointer)] = value;
  }
  return scene;
}

TEST_P(SceneRules, TheSceneItselfIsFine) {
  EXPECT_EQ(scene_cases::lines(read_scene(golden_["scene"], scene_cases::no_meshes)), "");
}

TEST_P(SceneRules, EachMistakeHasItsOneError) {
  ASSERT_GE(golden_["mistakes"].size(), 20U);
  for (const Json& mistake : golden_["mistakes"]) {
    const Result<Scene> scene =
        read_scene(with_changes(golden_["scene"], mistake["change"]), scene_cases::no_meshes);
    EXPECT_EQ(scene_cases::lines(scene),
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
}  // namespace vat::scene_json_mistakes_test
