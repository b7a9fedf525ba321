#pragma once

#include <string>

#include "core/scene/scene.h"
#include "core/support/result.h"

namespace vat {

inline constexpr std::size_t kMaxObjBytes = 16 * 1024 * 1024;  // sufficient for 200 000 triangles

/// Returns the content of a Wavefront `.obj` text as one mesh. Polygons are split into triangles,
/// and coordinates are multiplied by `scale`. Ignores normals, textures, lines and points. `source`
/// is the name for error messages. Error codes: bad_mesh, too_large.
Result<MeshShape> read_obj(const std::string& text, const std::string& source, Real scale);

}  // namespace vat
