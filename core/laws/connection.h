#pragma once

#include "core/types.h"

namespace vat {

/// How hard a spring and dashpot pushes its two ends apart (Boldt eq. 3), `distance` [m] apart and
/// receding at `speed` [m/s]; negative where it pulls, which contacts do not.
inline Real connection_push(Real stiffness, Real damping, Real rest_length, Real distance,
                            Real speed) {
  return stiffness * (rest_length - distance) - damping * speed;
}

}  // namespace vat
