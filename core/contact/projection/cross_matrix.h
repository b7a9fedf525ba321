#pragma once

#include "core/types.h"

namespace vat {

/// Returns the matrix A with A x = a cross x.
inline Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

}  // namespace vat
