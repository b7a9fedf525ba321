#pragma once

#include "core/types.h"

namespace vat {

/// Returns the repulsion of a spring with a dashpot (Boldt eq. 3) between two ends at `distance`
/// [m] that separate at `speed` [m/s]. The result [N] is negative for an attraction. Contacts
/// replace a negative result by 0.
inline Real connection_push(Real stiffness, Real damping, Real rest_length, Real distance,
                            Real speed) {
  return stiffness * (rest_length - distance) - damping * speed;
}

}  // namespace vat
