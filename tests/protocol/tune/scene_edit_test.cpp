#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "protocol/scene/scene_json.h"
#include "protocol/tune/scene_edit.h"

namespace vat::scene_edit_test {
namespace {

namespace fs = std::filesystem;

using testing::EndsWith;
using testing::StartsWith;
using tune::Candidate;
using tune::with_numerics;

Candidate candidate() {
  Candidate chosen;
  chosen.pressure_solver = PressureSolver::incompressible;
  chosen.incompressible = {1e-3, 1e-4, 50};
  chosen.numerics = {IntegratorId::symplectic_euler, 0.02 / 3, 0.02, StepControl::adaptive, 0.03};
  return chosen;
}

constexpr const char* kNumerics =
    R"({"integrator": "symplectic_euler", "step": 0.006666666666666667, "tick": 0.02, )"
    R"("control": "adaptive", "tolerance": 0.03})";
constexpr const char* kSolve =
    R"({"density_tolerance": 0.001, "divergence_tolerance": 0.0001, "most_iterations": 50})";

TEST(SceneEdit, OnlyTheValuesOfTheNumericsChange) {
  const std::string text =
      "{ \"title\" : \"a \\\" } numerics\",\n\t\"numerics\":{\"accuracy\":1e-2} ,\n"
      "  \"x\": [{\"numerics\": 1}, -1.50e+3, [true]],\"z\":null\n}\n\n";
  const std::string expected =
      "{ \"title\" : \"a \\\" } numerics\",\n\t\"numerics\":" + std::string(kNumerics) +
      " ,\n  \"x\": [{\"numerics\": 1}, -1.50e+3, [true]],\"z\":null\n}\n\n";
  EXPECT_EQ(with_numerics(text, candidate(), false).value(), expected);
}

TEST(SceneEdit, LiquidsAlsoHaveASolver) {
  const std::string text =
      R"({"incompressible": {}, "numerics": 1, "pressure_solver": "tait", "last": 0})";
  EXPECT_EQ(with_numerics(text, candidate(), true).value(),
            R"({"incompressible": )" + std::string(kSolve) + R"(, "numerics": )" + kNumerics +
                R"(, "pressure_solver": "incompressible", "last": 0})");
}

TEST(SceneEdit, AbsentMembersFollowTheNumerics) {
  EXPECT_EQ(with_numerics(R"({"numerics": {}, "last": 0})", candidate(), true).value(),
            R"({"numerics": )" + std::string(kNumerics) +
                ",\n  \"pressure_solver\": \"incompressible\",\n  \"incompressible\": " + kSolve +
                R"(, "last": 0})");
  EXPECT_EQ(with_numerics(R"({"last": 0})", candidate(), false).value(),
            "{\n  \"numerics\": " + std::string(kNumerics) + R"(,"last": 0})");
  EXPECT_EQ(with_numerics("{}", candidate(), false).value(),
            "{\n  \"numerics\": " + std::string(kNumerics) + "}");
}

TEST(SceneEdit, EscapedKeysAreFound) {
  EXPECT_EQ(with_numerics(R"({"numer\u0069cs": [1, "]"]})", candidate(), false).value(),
            R"({"numer\u0069cs": )" + std::string(kNumerics) + "}");
}

TEST(SceneEdit, OtherTextsAreRejected) {
  for (const char* text : {"", "{", "[]", "1", R"({"numerics": 1,})"}) {
    EXPECT_FALSE(with_numerics(text, candidate(), false)) << text;
  }
}

std::string text_of(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(SceneEdit, EditedCatalogueScenesDifferInTheirNumericsOnly) {
  std::size_t scenes = 0;
  for (const auto& entry : fs::directory_iterator(VAT_SOURCE_DIR "/protocol/scenes")) {
    if (entry.path().extension() != ".json") continue;
    ++scenes;
    const std::string text = text_of(entry.path());
    const MeshSource meshes = meshes_in_folder(entry.path().parent_path().string());
    Scene scene = read_scene_text(text, meshes).value();
    Candidate chosen = tune::candidate_of(scene);
    chosen.numerics.control = StepControl::adaptive;
    chosen.numerics.tolerance = 0.05;
    chosen.numerics.step = scene.numerics.tick / 7;
    const auto edited = with_numerics(text, chosen, true);
    ASSERT_TRUE(edited) << entry.path();
    const Result<Scene> read = read_scene_text(edited.value(), meshes);
    ASSERT_TRUE(read) << entry.path();
    EXPECT_EQ(write_scene(read.value()), write_scene(with_candidate(scene, chosen)));
    const std::string only_numerics = with_numerics(text, chosen, false).value();
    const std::size_t begin = text.find("\"numerics\": {");
    const std::size_t end = text.find('}', begin);
    EXPECT_THAT(only_numerics, StartsWith(text.substr(0, begin)));
    EXPECT_THAT(only_numerics, EndsWith(text.substr(end)));
  }
  EXPECT_GT(scenes, 10u);
}

}  // namespace
}  // namespace vat::scene_edit_test
