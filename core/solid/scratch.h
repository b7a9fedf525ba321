#pragma once

#include <vector>

#include "core/stage/scratch.h"
#include "core/types.h"

namespace vat {

/// Buffers of deformable bodies.
struct SolidScratch {
  static constexpr Method kMethod = Method::solid;

  std::vector<Real> cell_pressure;  ///< indexed by cell [Pa]
  /// Unit vector n of (Boldt eq. 3), by spring end. Only if Scratch::keep_dampers is set.
  std::vector<Vec3> spring_directions;
};

}  // namespace vat
