#include "protocol/scene/obj_mesh.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "core/limits.h"
#include "protocol/json/printable.h"

namespace vat {
namespace {

constexpr std::string_view kBlank = " \t\r";

/// Removes the first word of `line` and returns it. Returns an empty text if there is none.
std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlank));
  line.remove_prefix(word.size());
  return word;
}

bool is_finite_number(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double number = 0;
  const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), number);
  return failure == std::errc() && end == word.data() + word.size() && std::isfinite(number);
}

/// Returns the number, from 1, of the first line with an invalid vertex; 0 if all are valid. The
/// library replaces unreadable coordinates by 0 and reports no error.
std::size_t bad_vertex_line(std::string_view text) {
  for (std::size_t number = 1; !text.empty(); ++number) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (take_word(line) != "v") continue;
    for (int axis = 0; axis < 3; ++axis) {
      if (!is_finite_number(take_word(line))) return number;
    }
  }
  return 0;
}

std::size_t triangle_count(const tinyobj::ObjReader& reader) {
  std::size_t count = 0;
  for (const tinyobj::shape_t& shape : reader.GetShapes()) count += shape.mesh.indices.size() / 3;
  return count;
}

/// Returns false if a coordinate is not finite or exceeds kMaxLength.
bool read_vertices(const std::vector<tinyobj::real_t>& coordinates, Real scale, MeshShape& mesh) {
  mesh.vertices.reserve(coordinates.size() / 3);
  for (std::size_t i = 0; i + 2 < coordinates.size(); i += 3) {
    const Vec3 vertex = scale * Vec3(coordinates[i], coordinates[i + 1], coordinates[i + 2]);
    // The negation also detects NaN.
    if (!(vertex.array().abs() <= kMaxLength).all()) return false;
    mesh.vertices.push_back(vertex);
  }
  return true;
}

/// Returns false if a face refers to a vertex that does not exist.
bool read_triangles(const tinyobj::mesh_t& faces, MeshShape& mesh) {
  for (std::size_t i = 0; i + 2 < faces.indices.size(); i += 3) {
    std::array<Index, 3> triangle{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const int vertex = faces.indices[i + corner].vertex_index;
      if (vertex < 0 || static_cast<std::size_t>(vertex) >= mesh.vertices.size()) return false;
      triangle[corner] = static_cast<Index>(vertex);
    }
    mesh.triangles.push_back(triangle);
  }
  return true;
}

}  // namespace

Error mesh_error(const std::string& source, const std::string& fault) {
  return {"bad_mesh", "", source + ": " + fault};
}

Result<MeshShape> read_obj(const std::string& text, const std::string& source, Real scale) {
  if (const std::size_t line = bad_vertex_line(text); line != 0) {
    return mesh_error(source, "line " + std::to_string(line) + ": a vertex needs three numbers");
  }
  tinyobj::ObjReaderConfig config;
  config.triangulate = true;
  config.vertex_color = false;
  tinyobj::ObjReader reader;
  if (!reader.ParseFromString(text, "", config)) {
    return mesh_error(source, "not a readable .obj file: " + printable(reader.Error()));
  }
  const std::size_t triangles = triangle_count(reader);
  if (triangles == 0) return mesh_error(source, "has no faces");
  if (triangles > kMaxMeshTriangles) {
    return mesh_error(source, "has " + std::to_string(triangles) + " triangles; at most " +
                                  std::to_string(kMaxMeshTriangles) + " are allowed");
  }
  MeshShape mesh;
  mesh.source = source;
  if (!read_vertices(reader.GetAttrib().vertices, scale, mesh)) {
    return mesh_error(source, "every coordinate times the scale must be within 1e6 m");
  }
  mesh.triangles.reserve(triangles);
  for (const tinyobj::shape_t& shape : reader.GetShapes()) {
    if (!read_triangles(shape.mesh, mesh)) {
      return mesh_error(source, "a face names a vertex that does not exist");
    }
  }
  return mesh;
}

}  // namespace vat
