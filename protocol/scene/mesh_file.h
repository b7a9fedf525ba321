#pragma once

#include <functional>
#include <string>

#include "core/scene/body.h"
#include "core/support/result.h"
#include "core/types.h"

namespace vat {

inline constexpr std::size_t kMaxMeshBytes = 16 * 1024 * 1024;  // sufficient for 200 000 triangles

/// Function that returns the bytes of a file by its name, or an error.
using MeshFiles = std::function<Result<std::string>(const std::string& name)>;

/// Returns the content of a file as one mesh. The ending of `file` is the format: .obj, .stl (text
/// or binary), .ply (text or binary), .glb or .gltf (glTF 2.0). Polygons are split into triangles,
/// and coordinates are multiplied by `scale`. In glTF, y points up; z does in the result. Ignores
/// normals, textures, lines and points. Except for .obj, vertices at one position become one
/// vertex. `files` returns the buffers of glTF that are separate files, in the folder of `file`.
/// Error codes: bad_mesh, too_large.
Result<MeshShape> read_mesh(const std::string& bytes, const std::string& file, Real scale,
                            const MeshFiles& files = {});

}  // namespace vat
