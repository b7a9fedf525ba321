#pragma once

#include <functional>
#include <vector>

#include "tests/validation/run.h"

namespace vat::validation {

/// A quantity that oscillates about zero.
struct Swing {
  std::vector<Real> zeros;     ///< times of sign changes [s]
  std::vector<Real> extremes;  ///< maximum magnitudes between successive zeros
};

/// Advances to `until`, a whole number of hundredths of a second, and samples `quantity` after
/// each.
Swing observe_swing(Run& run, Real until, const std::function<Real()>& quantity);

}  // namespace vat::validation
