#pragma once

#include <vector>

#include "core/types.h"

namespace vat::validation {

/// y = at_zero + slope x.
struct Line {
  Real slope = 0;
  Real at_zero = 0;
};

/// By least squares over the points with x from `least` to `most`; at least two different.
Line fitted_line(const std::vector<Real>& x, const std::vector<Real>& y, Real least, Real most);

}  // namespace vat::validation
