#pragma once

#include <string>

#include "core/scene/scene.h"
#include "core/support/result.h"

namespace vat {

inline constexpr std::size_t kMaxObjBytes = 16 * 1024 * 1024;  // sufficient for 200 000 triangles

/// Reads a Wavefront `.obj` text. Returns all objects as one mesh, with polygons split into
/// triangles and coordinates multiplied by `scale`. Ignores normals, textures, lines and points.
/// `source` is the name in error messages. Codes: bad_mesh, too_large.
Result<MeshShape> read_obj(const std::string& text, const std::string& source, Real scale);

}  // namespace vat
