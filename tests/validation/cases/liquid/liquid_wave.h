#pragma once

#include <functional>
#include <vector>

#include "tests/validation/run.h"

namespace vat::validation {

/// Of a quantity that swings about zero.
struct Swing {
  std::vector<Real> zeros;     ///< times at which it changes its sign [s]
  std::vector<Real> extremes;  ///< its greatest magnitudes from one of them to the next
};

/// Runs on to `until`, a whole number of hundredths of a second, and looks at `quantity` after
/// each.
Swing observe_swing(Run& run, Real until, const std::function<Real()>& quantity);

}  // namespace vat::validation
