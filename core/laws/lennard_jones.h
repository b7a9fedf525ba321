#pragma once

#include <algorithm>
#include <cmath>

#include "core/types.h"

/// The layer of [MM04] about a body, with the force of M. Mueller, S. Schirm, M. Teschner,
/// B. Heidelberger, M. Gross, Computer Animation and Virtual Worlds 15 (2004) 159: like that of a
/// Lennard-Jones potential, it pushes below the distance l and pulls above it, but it is finite at
/// distance 0 and ends at h = l + a with slope 0. With u = h - r, and scaled here so that its slope
/// at l is that of a spring of stiffness k,
///
///   F(r) = k u^2 (u^2 - a^2) / (2 a^3).
///
/// It is a function of the distance alone, so it keeps energy: parting two particles at rest at l
/// takes k a^2 / 15, against a pull of at most k a / 8.
namespace vat {

/// F [N], positive where it pushes, for r < h.
inline Real layer_push(Real stiffness, Real width, Real threshold, Real distance) {
  const Real u = threshold - distance;
  return stiffness * u * u * (u * u - width * width) / (2 * width * width * width);
}

/// What it takes to bring the two to r < h from afar [J].
inline Real layer_energy(Real stiffness, Real width, Real threshold, Real distance) {
  const Real u = threshold - distance;
  return stiffness * u * u * u * (u * u / 5 - width * width / 3) / (2 * width * width * width);
}

/// -F'(r) [N/m].
inline Real layer_slope(Real stiffness, Real width, Real threshold, Real distance) {
  const Real u = threshold - distance;
  return stiffness * u * (2 * u * u - width * width) / (width * width * width);
}

/// The greatest |F'| [N/m] of those at r and beyond: -F' grows towards r = 0, and beyond l it is
/// above -k / 3.
inline Real greatest_layer_slope(Real stiffness, Real width, Real threshold, Real distance) {
  return std::max(stiffness, layer_slope(stiffness, width, threshold, distance));
}

}  // namespace vat
