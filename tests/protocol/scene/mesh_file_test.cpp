#include "protocol/scene/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/protocol/scene/scene_json_cases.h"

namespace vat::mesh_file_test {
namespace {

using scene_cases::lines;
using testing::HasSubstr;

// A tetrahedron with the edge lengths 1, 2 and 3 m along the axes.
const std::vector<std::array<float, 3>> kVertices = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
const std::vector<std::array<std::uint16_t, 3>> kTriangles = {
    {0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

template <class Value>
void append(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string words(const std::array<float, 3>& vertex) {
  return std::to_string(vertex[0]) + ' ' + std::to_string(vertex[1]) + ' ' +
         std::to_string(vertex[2]);
}

std::string stl_text() {
  std::string text = "solid tetrahedron\n";
  for (const auto& triangle : kTriangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const auto corner : triangle) text += "vertex " + words(kVertices[corner]) + '\n';
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid tetrahedron\n";
}

std::string binary_stl() {
  std::string bytes(80, ' ');
  append(bytes, static_cast<std::uint32_t>(kTriangles.size()));
  for (const auto& triangle : kTriangles) {
    append(bytes, std::array<float, 3>{});
    for (const auto corner : triangle) append(bytes, kVertices[corner]);
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string ply_text() {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& vertex : kVertices) text += words(vertex) + '\n';
  for (const auto& [a, b, c] : kTriangles) {
    text += "3 " + std::to_string(a) + ' ' + std::to_string(b) + ' ' + std::to_string(c) + '\n';
  }
  return text;
}

/// The vertices with y up, (x, z, -y), at the distance of a node, and the triangles.
std::string gltf_buffer() {
  std::string bytes;
  for (const auto& [x, y, z] : kVertices) append(bytes, std::array{x - 10, z, -y});
  for (const auto& triangle : kTriangles) append(bytes, triangle);
  return bytes;
}

/// A node moves the vertices by 10 m.
constexpr const char* kGltf = R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "translation": [10, 0, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "buffers": [{"byteLength": 72}],
    "bufferViews": [{"buffer": 0, "byteLength": 48},
                    {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                  {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}]})";

std::string glb(std::string json = kGltf) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string buffer = gltf_buffer();
  std::string bytes = "glTF";
  append(bytes, std::uint32_t{2});
  append(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
  append(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  append(bytes, static_cast<std::uint32_t>(buffer.size()));
  return bytes + std::string("BIN\0", 4) + buffer;
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t b = 0; b < 3; ++b) {
      bits = bits << 8 | (i + b < bytes.size() ? static_cast<unsigned char>(bytes[i + b]) : 0U);
    }
    for (std::size_t c = 0; c < 4; ++c) {
      text += i * 4 + c * 3 > bytes.size() * 4 ? '=' : kLetters[bits >> (18 - 6 * c) & 63];
    }
  }
  return text;
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// The same document with the URI of its buffer.
std::string gltf(const std::string& uri) {
  return with(kGltf, "\"byteLength\": 72", "\"byteLength\": 72, \"uri\": \"" + uri + '"');
}

std::string embedded_gltf() {
  return gltf("data:application/octet-stream;base64," + base64(gltf_buffer()));
}

struct Format {
  const char* file;
  std::string bytes;
};

void PrintTo(const Format& format, std::ostream* out) {
  *out << format.file;
}

class ReadMesh : public testing::TestWithParam<Format> {};

/// Returns the volume inside the mesh, which is negative if its triangles are clockwise [m^3].
Real volume_of(const MeshShape& mesh) {
  Real volume = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6;
  }
  return volume;
}

TEST_P(ReadMesh, GivesTheMeshOfEachFormat) {
  const Result<MeshShape> mesh = read_mesh(GetParam().bytes, GetParam().file, 2);
  ASSERT_EQ(lines(mesh), "") << mesh.errors()[0].message;
  EXPECT_EQ(mesh.value().source, GetParam().file);
  EXPECT_EQ(mesh.value().triangles.size(), 4U);
  EXPECT_THAT(mesh.value().vertices, testing::UnorderedElementsAre(Vec3(0, 0, 0), Vec3(2, 0, 0),
                                                                   Vec3(0, 4, 0), Vec3(0, 0, 6)));
  EXPECT_DOUBLE_EQ(volume_of(mesh.value()), 8 * 1.0);  // 1 * 2 * 3 / 6 at twice the scale
}

TEST_P(ReadMesh, RefusesEachBrokenFile) {
  const Format& format = GetParam();
  for (const std::string& bytes :
       {std::string(), std::string(200, 'x'), format.bytes.substr(0, format.bytes.size() / 2)}) {
    const Result<MeshShape> mesh = read_mesh(bytes, format.file, 1);
    ASSERT_EQ(lines(mesh), "bad_mesh \n") << bytes.size();
    EXPECT_THAT(mesh.errors()[0].message, HasSubstr(format.file));
  }
  EXPECT_EQ(lines(read_mesh(format.bytes, format.file, 1e6)), "bad_mesh \n");
}

INSTANTIATE_TEST_SUITE_P(Of, ReadMesh,
                         testing::Values(Format{"text.stl", stl_text()},
                                         Format{"binary.STL", binary_stl()},
                                         Format{"text.ply", ply_text()}, Format{"mesh.glb", glb()},
                                         Format{"mesh.gltf", embedded_gltf()}));

struct Mistake {
  const char* file;
  std::string bytes;
  const char* message;
};

TEST(ReadMeshFile, NamesTheMistake) {
  const std::string ply = ply_text();
  for (const Mistake& mistake : {
           Mistake{"a.stl", with(stl_text(), "endloop", "end"), "'endloop' is missing"},
           Mistake{"a.stl", with(stl_text(), "vertex 1", "vertex nan"), "three numbers"},
           Mistake{"a.ply", with(ply, "\n3 0 2 1", "\n3 0 2 4"), "out of range"},
           Mistake{"a.ply", with(ply, "\n3 0 2 1", "\n3 0 2 -1"), "out of range"},
           Mistake{"a.ply", with(ply, "\n3 0 2 1", "\n3 0 2 0.5"), "out of range"},
           Mistake{"a.ply", with(ply, "property float z\n", ""), "needs x, y and z"},
           Mistake{"a.ply", with(ply, "vertex 4", "vertex -4"), "needs a number"},
           Mistake{"a.ply", with(ply, "float x", "half x"), "'half' is not a type"},
           Mistake{"a.ply", with(ply, "ascii", "utf8"), "'utf8' is not a format"},
           Mistake{"a.ply", with(ply, "face 4", "face 0"), "has no faces"},
           Mistake{"a.glb", glb(with(kGltf, "\"count\": 4", "\"count\": 5")), "beyond its view"},
           Mistake{"a.glb", glb(with(kGltf, "\"byteLength\": 24", "\"byteLength\": 25")),
                   "beyond the buffer"},
           Mistake{"a.glb", glb(with(kGltf, "5123", "5121")), "has no faces"},
           Mistake{"a.glb", glb(with(kGltf, "5126", "5130")), "another type of numbers"},
           Mistake{"a.glb", glb(with(kGltf, "\"mesh\": 0", "\"mesh\": 1")), "does not exist"},
           Mistake{"a.glb", glb(with(kGltf, "\"mesh\": 0", "\"children\": [0]")), "not trees"},
           Mistake{"a.glb", glb(with(kGltf, "[10, 0, 0]", "[10, 0]")), "needs 3 numbers"},
           Mistake{"a.glb", glb(with(kGltf, "\"indices\"", "\"mode\": 5, \"indices\"")), "strips"},
           Mistake{"a.glb", glb(with(kGltf, "\"scene\"", "\"extensionsRequired\": [], \"scene\"")),
                   "extensions"},
           Mistake{"a.gltf", with(embedded_gltf(), ";base64", ""), "needs base64"},
           Mistake{"a.gltf", with(embedded_gltf(), ";base64,", ";base64,*"), "not base64"},
           Mistake{"a.gltf", with(embedded_gltf(), "\"buffer\": 0", "\"buffer\": 1"),
                   "a buffer does not exist"},
           Mistake{"a.gltf", with(embedded_gltf(), "[{\"byteLength\"", "[7, {\"byteLength\""),
                   "'uri' belongs to an object"},
           Mistake{"a.gltf", kGltf, "beyond the buffer"},
           Mistake{"a.gltf", gltf("a.bin"), "needs its buffer in the file"},
       }) {
    const Result<MeshShape> mesh = read_mesh(mistake.bytes, mistake.file, 1);
    ASSERT_EQ(lines(mesh), "bad_mesh \n") << mistake.message;
    EXPECT_THAT(mesh.errors()[0].message, HasSubstr(mistake.message));
  }
}

TEST(ReadMeshFile, BuffersAreFilesInTheFolderOfTheMesh) {
  const MeshFiles files = [](const std::string& name) -> Result<std::string> {
    if (name == "parts/the buffer.bin") return gltf_buffer();
    return Error{"no_such_file", "", name + ": is not there"};
  };
  const Result<MeshShape> mesh = read_mesh(gltf("the%20buffer.bin"), "parts/a.gltf", 1, files);
  ASSERT_EQ(lines(mesh), "");
  EXPECT_DOUBLE_EQ(volume_of(mesh.value()), 1);
  const Result<MeshShape> other = read_mesh(gltf("other.bin"), "parts/a.gltf", 1, files);
  ASSERT_EQ(lines(other), "bad_mesh \n");
  EXPECT_THAT(other.errors()[0].message, HasSubstr("parts/other.bin: is not there"));
}

TEST(ReadMeshFile, BuffersStayBelowTheFolderOfTheScene) {
  const Result<MeshShape> mesh =
      read_mesh(gltf("../../etc/hosts"), "parts/a.gltf", 1, meshes_in_folder("."));
  ASSERT_EQ(lines(mesh), "bad_mesh \n");
  EXPECT_THAT(mesh.errors()[0].message, HasSubstr("must be a file below the scene's folder"));
}

TEST(ReadMeshFile, BuffersHaveALimit) {
  const MeshFiles files = [](const std::string&) -> Result<std::string> {
    return std::string(kMaxMeshBytes / 2, '\0');
  };
  const auto with_buffers = [](int count) {
    std::string buffers = "{\"byteLength\": 1, \"uri\": \"a.bin\"}";
    for (int i = 1; i < count; ++i) buffers += ", {\"byteLength\": 1, \"uri\": \"a.bin\"}";
    return with(kGltf, "{\"byteLength\": 72}", buffers);
  };
  const auto message = [&](int count) {
    return read_mesh(with_buffers(count), "a.gltf", 1, files).errors()[0].message;
  };
  EXPECT_THAT(message(2), testing::Not(HasSubstr("more than")));
  EXPECT_THAT(message(3), HasSubstr("buffers have more than 16777216 bytes"));
  EXPECT_THAT(message(65), HasSubstr("a list of at most 64"));
}

TEST(ReadMeshFile, MirroredNodesKeepTheirOutside) {
  const std::string json = with(kGltf, "\"translation\": [10, 0, 0]", "\"scale\": [-1, 1, 1]");
  const Result<MeshShape> mesh = read_mesh(glb(json), "a.glb", 1);
  ASSERT_EQ(lines(mesh), "");
  EXPECT_DOUBLE_EQ(volume_of(mesh.value()), 1);
}

TEST(ReadMeshFile, SplitsPolygonsAndReadsOverOtherElements) {
  const Result<MeshShape> mesh = read_mesh(
      "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty double x\n"
      "property double y\nproperty double z\nproperty uchar red\nelement edge 1\n"
      "property list uchar int ends\nelement face 1\nproperty float weight\n"
      "property list uint8 uint32 vertex_index\nend_header\n"
      "0 0 0 255\n1 0 0 255\n1 1 0 255\n0 1 0 255\n2 0 1\n0.5 4 0 1 2 3\n",
      "a.ply", 1);
  ASSERT_EQ(lines(mesh), "");
  EXPECT_THAT(mesh.value().triangles,
              testing::ElementsAre(std::array<Index, 3>{0, 1, 2}, std::array<Index, 3>{0, 2, 3}));
}

TEST(ReadMeshFile, RefusesOtherEndingsAndLargeFiles) {
  for (const char* file : {"a", "a.dae", "stl", "a.stl.txt"}) {
    const Result<MeshShape> mesh = read_mesh(stl_text(), file, 1);
    ASSERT_EQ(lines(mesh), "bad_mesh \n") << file;
    EXPECT_THAT(mesh.errors()[0].message, HasSubstr("must end in"));
  }
  for (const char* file : {"a.obj", "a.stl"}) {
    EXPECT_EQ(lines(read_mesh(std::string(kMaxMeshBytes + 1, '\n'), file, 1)), "too_large \n");
  }
}

}  // namespace
}  // namespace vat::mesh_file_test
