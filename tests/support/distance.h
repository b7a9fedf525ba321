#pragma once

#include <cmath>

#include "core/types.h"

namespace vat::test {

/// Returns |a - b|, with the bits of (a - b).norm(). In tests, which are compiled without
/// optimisation, it takes a fraction of the time.
inline Real distance_between(const Vec3& a, const Vec3& b) {
  const Real* const p = a.data();
  const Real* const q = b.data();
  const Real x = p[0] - q[0];
  const Real y = p[1] - q[1];
  const Real z = p[2] - q[2];
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace vat::test
