#include <algorithm>

#include "core/limits.h"
#include "protocol/scene/mesh_parts.h"

namespace vat::mesh_parts {
namespace {

constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kTriangleBytes = 50;  // normal, three corners, two unused bytes

void add_triangle(const std::array<Vec3, 3>& corners, RawMesh& mesh) {
  const auto first = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
  // With the sum of all files' limits, a longer list has no use.
  if (mesh.triangles.size() > kMaxMeshTriangles) {
    throw Fault{"has more than " + std::to_string(kMaxMeshTriangles) + " triangles"};
  }
}

RawMesh read_binary(std::string_view bytes) {
  RawMesh mesh;
  while (!bytes.empty()) {
    std::string_view numbers = bytes.substr(3 * sizeof(float));  // after the normal
    bytes.remove_prefix(kTriangleBytes);
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) {
      for (Real& value : corner) value = static_cast<Real>(*take<float>(numbers));
    }
    add_triangle(corners, mesh);
  }
  return mesh;
}

void expect(std::string_view& text, std::string_view word) {
  const std::string_view found = take_word(text);
  if (found != word)
    throw Fault{"not a readable .stl file: '" + std::string(word) + "' is missing"};
}

Vec3 take_vector(std::string_view& text) {
  Vec3 vector;
  for (Real& value : vector) {
    const std::optional<double> number = to_number(take_word(text));
    if (!number) throw Fault{"not a readable .stl file: a vector needs three numbers"};
    value = *number;
  }
  return vector;
}

RawMesh read_text(std::string_view text) {
  text.remove_prefix(std::min(text.find('\n'), text.size()));  // "solid" and the name
  RawMesh mesh;
  std::string_view word = take_word(text);
  for (; word == "facet"; word = take_word(text)) {
    expect(text, "normal");
    take_vector(text);
    expect(text, "outer");
    expect(text, "loop");
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) {
      expect(text, "vertex");
      corner = take_vector(text);
    }
    expect(text, "endloop");
    expect(text, "endfacet");
    add_triangle(corners, mesh);
  }
  if (word != "endsolid") throw Fault{"not a readable .stl file: 'endsolid' is missing"};
  return mesh;
}

}  // namespace

// The header of a binary file can also begin with "solid".
RawMesh read_stl(std::string_view bytes) {
  if (bytes.size() >= kHeaderBytes + sizeof(std::uint32_t)) {
    std::string_view rest = bytes.substr(kHeaderBytes);
    const std::uint32_t count = *take<std::uint32_t>(rest);
    if (rest.size() == kTriangleBytes * count) return read_binary(rest);
  }
  if (bytes.starts_with("solid")) return read_text(bytes);
  throw Fault{"not a readable .stl file: its length differs from its number of triangles"};
}

}  // namespace vat::mesh_parts
