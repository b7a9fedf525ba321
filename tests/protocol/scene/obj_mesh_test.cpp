#include "protocol/scene/obj_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/limits.h"
#include "tests/protocol/scene/scene_json_cases.h"

namespace vat::obj_mesh_test {
namespace {

using scene_cases::lines;
using testing::ElementsAre;
using testing::HasSubstr;
using Triangle = std::array<Index, 3>;

TEST(ReadObj, GivesVerticesAndTriangles) {
  const Result<MeshShape> mesh =
      read_obj("# a comment\nv 0 0 0\nv 1 0 0.5\nv 0 -1 0\nf 1 2 3\nf -1 -2 -3\n", "m.obj", 2);
  ASSERT_EQ(lines(mesh), "");
  EXPECT_EQ(mesh.value().source, "m.obj");
  EXPECT_THAT(mesh.value().vertices, ElementsAre(Vec3(0, 0, 0), Vec3(2, 0, 1), Vec3(0, -2, 0)));
  EXPECT_THAT(mesh.value().triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{2, 1, 0}));
}

TEST(ReadObj, CutsPolygonsIntoTriangles) {
  const Result<MeshShape> mesh =
      read_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", "m", 1);
  ASSERT_EQ(lines(mesh), "");
  EXPECT_EQ(mesh.value().triangles.size(), 2U);
}

TEST(ReadObj, JoinsObjectsAndIgnoresOtherElements) {
  const Result<MeshShape> mesh = read_obj(
      "mtllib none.mtl\no one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nf 1/1/1 2/1/1 3/1/1\n"
      "o two\nusemtl x\nv 0 0 1\nl 1 2\np 1\nf 1 2 4\n",
      "m", 1);
  ASSERT_EQ(lines(mesh), "");
  EXPECT_THAT(mesh.value().triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 1, 3}));
}

TEST(ReadObj, RefusesBrokenMeshesWithTheirName) {
  for (const char* text :
       {"", "v 0 0 0\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -9 1 2\n",
        "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "v 2e6 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "\x7f\x45\x4c\x46\x02"}) {
    const Result<MeshShape> mesh = read_obj(text, "duck.obj", 1);
    ASSERT_EQ(lines(mesh), "bad_mesh \n") << text;
    EXPECT_THAT(mesh.errors()[0].message, HasSubstr("duck.obj: "));
  }
}

/// The library would read missing numbers as 0.
TEST(ReadObj, VerticesNeedThreeNumbers) {
  for (const char* vertex : {"v 1 0", "v", "v x 0 0", "v 0 1,5 0", "v 0 0 1e999", "v 0 inf 0"}) {
    const std::string text = "v 0 0 0\n\t v 1 +1 -.5e1\r\n" + std::string(vertex) + "\nf 1 2 3\n";
    const Result<MeshShape> mesh = read_obj(text, "m", 1);
    ASSERT_EQ(lines(mesh), "bad_mesh \n") << vertex;
    EXPECT_THAT(mesh.errors()[0].message, HasSubstr("line 3: "));
  }
}

TEST(ReadObj, TheScaleCountsForTheBounds) {
  const char* text = "v 2e6 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(lines(read_obj(text, "m", 0.5)), "");
  EXPECT_EQ(lines(read_obj(text, "m", 0.51)), "bad_mesh \n");
}

TEST(ReadObj, BoundsTheSizeOfTheMesh) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (std::size_t i = 0; i < kMaxMeshTriangles; ++i) text += "f 1 2 3\n";
  EXPECT_EQ(lines(read_obj(text, "m", 1)), "");
  const Result<MeshShape> mesh = read_obj(text + "f 1 2 3\n", "m", 1);
  ASSERT_EQ(lines(mesh), "bad_mesh \n");
  EXPECT_THAT(mesh.errors()[0].message, HasSubstr("at most 200000"));
}

}  // namespace
}  // namespace vat::obj_mesh_test
