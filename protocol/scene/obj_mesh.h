#pragma once

#include <string>

#include "core/scene/scene.h"
#include "core/support/result.h"

namespace vat {

inline constexpr std::size_t kMaxObjBytes = 16 * 1024 * 1024;  // 200 000 triangles, and slack

/// Reads the faces of a Wavefront `.obj` text: all objects as one mesh, polygons cut into
/// triangles, coordinates times `scale`; normals, textures, lines and points are ignored. `source`
/// is the name in the messages. Codes: bad_mesh, too_large.
Result<MeshShape> read_obj(const std::string& text, const std::string& source, Real scale);

}  // namespace vat
