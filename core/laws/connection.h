#pragma once

#include "core/types.h"

namespace vat {

/// The repulsion of a spring with a dashpot (Boldt eq. 3) between two ends at `distance` [m] that
/// separate at `speed` [m/s]. Negative for attraction, which contacts do not have.
inline Real connection_push(Real stiffness, Real damping, Real rest_length, Real distance,
                            Real speed) {
  return stiffness * (rest_length - distance) - damping * speed;
}

}  // namespace vat
