#pragma once

#include <vector>

#include "core/types.h"

namespace vat::validation {

/// The line y = at_zero + slope x.
struct Line {
  Real slope = 0;
  Real at_zero = 0;
};

/// Returns the least-squares fit of the points with x from `least` to `most`. There must be at
/// least two different x.
Line fitted_line(const std::vector<Real>& x, const std::vector<Real>& y, Real least, Real most);

}  // namespace vat::validation
