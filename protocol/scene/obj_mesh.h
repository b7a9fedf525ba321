#pragma once

#include <string>

#include "core/scene/body.h"
#include "core/support/result.h"
#include "core/types.h"

namespace vat {

/// Returns an error with the code bad_mesh about the mesh with the name `source`.
Error mesh_error(const std::string& source, const std::string& fault);

/// Returns the content of a Wavefront `.obj` text as one mesh. Polygons are split into triangles,
/// and coordinates are multiplied by `scale`. Ignores normals, textures, lines and points. `source`
/// is the name for error messages. Error code: bad_mesh.
Result<MeshShape> read_obj(const std::string& text, const std::string& source, Real scale);

}  // namespace vat
