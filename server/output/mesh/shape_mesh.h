#pragma once

#include <array>
#include <vector>

#include "core/scene/body.h"

namespace vat {

/// Surface of a shape as triangles, counter-clockwise seen from outside.
struct SurfaceMesh {
  std::vector<Vec3> vertices;  ///< in the frame of the shape [m]
  std::vector<std::array<Index, 3>> triangles;
};

/// Returns the surface of a shape, and an empty mesh for explicit particles. Round surfaces have
/// edges of about 11 degrees.
SurfaceMesh surface_of(const Shape& shape);

}  // namespace vat
