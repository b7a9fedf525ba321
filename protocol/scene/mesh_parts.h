#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/types.h"
#include "protocol/scene/mesh_file.h"

/// Parts of the readers of mesh formats. A reader returns the vertices and triangles of a file.
namespace vat::mesh_parts {

/// Vertices and triangles in the order of the file. Indices are in range.
struct RawMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<Index, 3>> triangles;
};

/// The fault of a file.
struct Fault {
  std::string text;
};

// The formats have little-endian numbers, except for .ply files that state otherwise.
static_assert(std::endian::native == std::endian::little);

/// Removes the first number from `bytes` and returns it. Returns nothing if they are too short.
template <class Number>
std::optional<Number> take(std::string_view& bytes, bool is_big_endian = false) {
  static_assert(std::is_arithmetic_v<Number>);
  if (bytes.size() < sizeof(Number)) return {};
  std::array<char, sizeof(Number)> raw;
  std::memcpy(raw.data(), bytes.data(), sizeof(Number));
  if (is_big_endian) std::reverse(raw.begin(), raw.end());
  bytes.remove_prefix(sizeof(Number));
  return std::bit_cast<Number>(raw);
}

/// Removes the first word from `text` and returns it. A word ends at white space. Returns an empty
/// word if `text` contains no word.
std::string_view take_word(std::string_view& text);
/// Returns the number, if the whole word is a finite number.
std::optional<double> to_number(std::string_view word);

/// Returns the mesh of an .stl file. Throws Fault.
RawMesh read_stl(std::string_view bytes);
/// Returns the mesh of a .ply file. Throws Fault.
RawMesh read_ply(std::string_view bytes);
/// Return the mesh of a .glb or .gltf file, in which z points up. `files` returns the buffers whose
/// URIs are relative to `folder`, which is empty or ends in '/'. Throw Fault.
RawMesh read_glb(std::string_view bytes, const std::string& folder, const MeshFiles& files);
RawMesh read_gltf(std::string_view text, const std::string& folder, const MeshFiles& files);

}  // namespace vat::mesh_parts
