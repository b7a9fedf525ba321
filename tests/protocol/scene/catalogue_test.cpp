#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/validation/validate.h"
#include "tests/protocol/scene/scene_json_cases.h"
#include "tests/support/temporary_folder.h"

namespace vat::catalogue_test {
namespace {

namespace fs = std::filesystem;
using namespace scene_cases;
using testing::HasSubstr;

constexpr const char* kScenesFolder = VAT_SOURCE_DIR "/protocol/scenes";

/// A temporary folder of scene files.
class SceneFiles : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    folder.write(name, text);
    return folder.file(name);
  }

  test::TemporaryFolder folder;
};

constexpr const char* kMinimal = R"({"format": "vat.scene/1", "materials": [], "bodies": []})";
constexpr const char* kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

TEST(WriteScene, EveryCatalogueSceneIsReadBitByBit) {
  const Result<Catalogue> catalogue = Catalogue::open(kScenesFolder);
  ASSERT_EQ(lines(catalogue), "");
  ASSERT_GE(catalogue.value().entries().size(), 6U);
  for (const CatalogueEntry& entry : catalogue.value().entries()) {
    const Scene& scene = *catalogue.value().find(entry.name);
    const Result<Scene> back = read_scene_text(write_scene(scene).dump(), no_meshes);
    ASSERT_EQ(lines(back), "") << entry.name;
    EXPECT_EQ(bits_of(back.value()), bits_of(scene)) << entry.name;
  }
}

TEST(CatalogueScenes, HaveNoWarnings) {
  const Result<Catalogue> catalogue = Catalogue::open(kScenesFolder);
  ASSERT_EQ(lines(catalogue), "");
  for (const CatalogueEntry& entry : catalogue.value().entries()) {
    for (const Warning& warning : find_warnings(*catalogue.value().find(entry.name))) {
      ADD_FAILURE() << entry.name << ": " << warning.path << ' ' << warning.message;
    }
  }
}

TEST(WriteScene, TheFullSceneIsReadBitByBit) {
  Scene scene = full_scene();
  scene.bodies[0].position = {0.1 + 0.2, -0.0,
                              1.0 / 3.0};  // values that short decimal texts do not represent
  const Result<Scene> back = read_scene_text(write_scene(scene).dump(), no_meshes);
  ASSERT_EQ(lines(back), "");
  EXPECT_EQ(bits_of(back.value()), bits_of(scene));
}

TEST(WriteScene, DefaultsComeBack) {
  const Result<Scene> back = read_scene_text(write_scene(Scene{}).dump(), no_meshes);
  ASSERT_EQ(lines(back), "");
  EXPECT_EQ(bits_of(back.value()), bits_of(Scene{}));
}

TEST_F(SceneFiles, ASceneWithoutANameGetsTheFiles) {
  const Result<Scene> scene = read_scene_file(write("still-water.json", kMinimal));
  ASSERT_EQ(lines(scene), "");
  EXPECT_EQ(scene.value().name, "still-water");
}

TEST_F(SceneFiles, MeshesAreReadBesideTheScene) {
  write("inside/tetra.obj", kTetrahedron);
  const Result<Scene> scene = read_scene_file(write("scene.json", R"({"format": "vat.scene/1",
      "materials": [{"name": "wood"}],
      "bodies": [{"name": "b", "kind": "rigid", "material": "wood", "spacing": 0.25,
                  "shape": {"type": "mesh", "file": "inside/tetra.obj", "scale": 2}}]})"));
  ASSERT_EQ(lines(scene), "");
  const auto& mesh = std::get<MeshShape>(scene.value().bodies[0].shape);
  EXPECT_EQ(mesh.source, "inside/tetra.obj");
  EXPECT_EQ(mesh.vertices.at(1), Vec3(2, 0, 0));
  EXPECT_EQ(mesh.triangles.at(0), (std::array<Index, 3>{0, 2, 1}));
}

TEST_F(SceneFiles, MeshesOutsideTheFolderAreRefused) {
  write("outside.obj", kTetrahedron);
  write("inside/inside.obj", kTetrahedron);
  const MeshSource meshes = meshes_in_folder(folder.file("inside"));
  const std::string absolute = folder.file("outside.obj");
  ASSERT_TRUE(fs::exists(absolute));
  for (const std::string& name :
       {std::string("../outside.obj"), absolute, std::string("./../outside.obj"),
        std::string("a/../../outside.obj"), std::string(".."), std::string("/"), std::string()}) {
    const Result<std::string> text = meshes(name);
    EXPECT_EQ(lines(text), "bad_file_name \n") << name;
  }
  EXPECT_EQ(lines(meshes("absent.obj")), "no_such_file \n");
  EXPECT_EQ(lines(meshes(".")), "no_such_file \n");  // a folder
}

TEST_F(SceneFiles, ErrorsOfAMeshNameTheMemberThatAsksForIt) {
  write("broken.obj", "v 0 0 0\nf 1 2 3\n");
  for (const auto& [file, code] :
       {std::pair("../x.obj", "bad_file_name"), std::pair("absent.obj", "no_such_file"),
        std::pair("broken.obj", "bad_mesh")}) {
    const std::string text = R"({"format": "vat.scene/1", "materials": [{"name": "wood"}],
      "bodies": [{"name": "b", "kind": "rigid", "material": "wood", "spacing": 0.25,
                  "shape": {"type": "mesh", "file": ")" +
                             std::string(file) + "\"}}]}";
    EXPECT_EQ(lines(read_scene_file(write("scene.json", text))),
              std::string(code) + " /bodies/0/shape/file\n");
  }
}

TEST_F(SceneFiles, UnreadableScenesAreRefused) {
  EXPECT_EQ(lines(read_scene_file(folder.file("absent.json"))), "no_such_file \n");
  EXPECT_EQ(lines(read_scene_file(folder.path().string())), "no_such_file \n");
  EXPECT_EQ(lines(read_scene_file(write("scene.json", "{"))), "parse_error \n");
  const std::string spaces(kSceneLimits.bytes + 1, ' ');
  EXPECT_EQ(lines(read_scene_file(write("scene.json", spaces))), "too_large \n");
}

TEST_F(SceneFiles, TheCatalogueListsItsScenesByFileName) {
  write("b.json", R"({"format": "vat.scene/1", "name": "other", "title": "T",
                      "description": "D", "materials": [], "bodies": []})");
  write("a.json", kMinimal);
  write("notes.txt", "not a scene");
  const Result<Catalogue> catalogue = Catalogue::open(folder.path().string());
  ASSERT_EQ(lines(catalogue), "");
  const std::vector<CatalogueEntry>& entries = catalogue.value().entries();
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[0].name, "a");
  EXPECT_EQ(entries[1].name, "b");
  EXPECT_EQ(entries[1].title, "T");
  EXPECT_EQ(entries[1].description, "D");
  ASSERT_NE(catalogue.value().find("b"), nullptr);
  EXPECT_EQ(catalogue.value().find("b")->title, "T");
  EXPECT_EQ(catalogue.value().find("other"), nullptr);
  EXPECT_EQ(catalogue.value().find("../a"), nullptr);
}

TEST_F(SceneFiles, TheCatalogueReportsEveryBadSceneWithItsFile) {
  write("a.json", "{");
  write("b.json", kMinimal);
  write("c.json", R"({"format": "vat.scene/1", "materials": 1, "bodies": []})");
  const Result<Catalogue> catalogue = Catalogue::open(folder.path().string());
  ASSERT_EQ(lines(catalogue), "parse_error \nwrong_type /materials\n");
  EXPECT_THAT(catalogue.errors()[0].message, HasSubstr("a.json: "));
  EXPECT_THAT(catalogue.errors()[1].message, HasSubstr("c.json: "));
}

TEST_F(SceneFiles, ACatalogueNeedsItsFolder) {
  EXPECT_EQ(lines(Catalogue::open(folder.file("absent"))), "no_such_folder \n");
  EXPECT_EQ(lines(Catalogue::open(write("file", "x"))), "no_such_folder \n");
}

}  // namespace
}  // namespace vat::catalogue_test
