#pragma once

#include <string>

#include "core/scene/scene.h"
#include "core/support/result.h"

namespace vat {

inline constexpr std::size_t kMaxMeshBytes = 16 * 1024 * 1024;  // sufficient for 200 000 triangles

/// Returns the content of a file as one mesh. The ending of `file` is the format: .obj, .stl (text
/// or binary), .ply (text or binary) or .glb (glTF 2.0). Polygons are split into triangles, and
/// coordinates are multiplied by `scale`. In glTF, y points up; z does in the result. Ignores
/// normals, textures, lines and points. Except for .obj, vertices at one position become one
/// vertex. Error codes: bad_mesh, too_large.
Result<MeshShape> read_mesh(const std::string& bytes, const std::string& file, Real scale);

}  // namespace vat
