#include "protocol/scene/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "core/limits.h"
#include "protocol/scene/mesh_parts.h"
#include "protocol/scene/obj_mesh.h"

namespace vat {
namespace mesh_parts {

std::string_view take_word(std::string_view& text) {
  constexpr std::string_view kBlank = " \t\r\n";
  text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBlank));
  text.remove_prefix(word.size());
  return word;
}

std::optional<double> to_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double number = 0;
  const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool is_whole = failure == std::errc() && end == word.data() + word.size();
  return is_whole && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

}  // namespace mesh_parts

namespace {

using mesh_parts::Fault;
using mesh_parts::RawMesh;

std::string ending_of(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

RawMesh read_raw(const std::string& bytes, const std::string& file, const MeshFiles& files) {
  const std::string ending = ending_of(file);
  const std::string folder = file.substr(0, file.rfind('/') + 1);
  if (ending == ".stl") return mesh_parts::read_stl(bytes);
  if (ending == ".ply") return mesh_parts::read_ply(bytes);
  if (ending == ".glb") return mesh_parts::read_glb(bytes, folder, files);
  if (ending == ".gltf") return mesh_parts::read_gltf(bytes, folder, files);
  throw Fault{"must end in .obj, .stl, .ply, .glb or .gltf"};
}

bool is_before(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// Appends the vertices without repetitions, in the order of their first use, and the triangles.
/// Removes triangles with two equal corners.
void join_vertices(const RawMesh& raw, Real scale, MeshShape& mesh) {
  std::vector<std::size_t> order(raw.vertices.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    if (is_before(raw.vertices[a], raw.vertices[b])) return true;
    return !is_before(raw.vertices[b], raw.vertices[a]) && a < b;
  });
  std::vector<std::size_t> first(raw.vertices.size());  // of the vertices at this position
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeats = i > 0 && raw.vertices[order[i]] == raw.vertices[order[i - 1]];
    first[order[i]] = repeats ? first[order[i - 1]] : order[i];
  }
  constexpr Index kNone = ~Index{0};
  std::vector<Index> numbers(raw.vertices.size(), kNone);
  for (const auto& corners : raw.triangles) {
    std::array<Index, 3> triangle{};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t vertex = first[corners[c]];
      if (numbers[vertex] == kNone) {
        numbers[vertex] = static_cast<Index>(mesh.vertices.size());
        mesh.vertices.push_back(scale * raw.vertices[vertex]);
      }
      triangle[c] = numbers[vertex];
    }
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
      continue;
    }
    mesh.triangles.push_back(triangle);
  }
}

MeshShape to_mesh(const RawMesh& raw, const std::string& file, Real scale) {
  if (raw.triangles.size() > kMaxMeshTriangles) {
    throw Fault{"has " + std::to_string(raw.triangles.size()) + " triangles; at most " +
                std::to_string(kMaxMeshTriangles) + " are allowed"};
  }
  for (const Vec3& vertex : raw.vertices) {
    // The negation also detects NaN.
    if (!((scale * vertex).array().abs() <= kMaxLength).all()) {
      throw Fault{"every coordinate times the scale must be within 1e6 m"};
    }
  }
  MeshShape mesh;
  mesh.source = file;
  join_vertices(raw, scale, mesh);
  if (mesh.triangles.empty()) throw Fault{"has no faces"};
  return mesh;
}

}  // namespace

Result<MeshShape> read_mesh(const std::string& bytes, const std::string& file, Real scale,
                            const MeshFiles& files) {
  if (bytes.size() > kMaxMeshBytes) {
    return Error{"too_large", "",
                 file + ": at most " + std::to_string(kMaxMeshBytes) + " bytes are allowed"};
  }
  if (ending_of(file) == ".obj") return read_obj(bytes, file, scale);
  try {
    return to_mesh(read_raw(bytes, file, files), file, scale);
  } catch (const Fault& fault) {
    return mesh_error(file, fault.text);
  }
}

}  // namespace vat
