#pragma once

#include <algorithm>

#include "core/types.h"

/// The layer of [MM04] about a body, with the force of M. Mueller, S. Schirm, M. Teschner, B.
/// Heidelberger, M. Gross, Computer Animation and Virtual Worlds 15 (2004) 159. Like the force of a
/// Lennard-Jones potential, it repels below the distance l and attracts above it. It is finite at
/// distance 0, and ends at h = l + a with slope 0. It is scaled so that its slope at l is that of a
/// spring with stiffness k. With u = h - r:
///
///   F(r) = k u^2 (u^2 - a^2) / (2 a^3).
///
/// It depends on the distance only and therefore conserves energy. Separating two particles at rest
/// at l takes the energy k a^2 / 15, against an attraction of at most k a / 8.
namespace vat {

/// The force F [N], positive for repulsion, for r < h.
inline Real layer_push(Real stiffness, Real width, Real threshold, Real distance) {
  const Real u = threshold - distance;
  return stiffness * u * u * (u * u - width * width) / (2 * width * width * width);
}

/// The energy of two particles at r < h, relative to that at large distances [J].
inline Real layer_energy(Real stiffness, Real width, Real threshold, Real distance) {
  const Real u = threshold - distance;
  return stiffness * u * u * u * (u * u / 5 - width * width / 3) / (2 * width * width * width);
}

/// The stiffness -F'(r) [N/m].
inline Real layer_slope(Real stiffness, Real width, Real threshold, Real distance) {
  const Real u = threshold - distance;
  return stiffness * u * (2 * u * u - width * width) / (width * width * width);
}

/// The maximum of |F'| [N/m] at the distances from r on: -F' grows towards r = 0, and beyond l it
/// is above -k / 3.
inline Real greatest_layer_slope(Real stiffness, Real width, Real threshold, Real distance) {
  return std::max(stiffness, layer_slope(stiffness, width, threshold, distance));
}

}  // namespace vat
