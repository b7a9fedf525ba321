#pragma once

#include <algorithm>

#include "core/types.h"

/// The adhesive layer of a body after [MM04], with the force of M. Mueller, S. Schirm, M. Teschner,
/// B. Heidelberger, M. Gross, Computer Animation and Virtual Worlds 15 (2004) 159. Like a
/// Lennard-Jones force, this force is repulsive below the distance l and attractive above l. The
/// force is finite at distance 0, and decreases to 0 at the reach h = l + a with slope 0. The slope
/// at l is that of a spring with the stiffness k. With u = h - r and the width a of the layer:
///
///   F(r) = k u^2 (u^2 - a^2) / (2 a^3).
///
/// The force depends only on the distance, so that energy is conserved. The energy needed to
/// separate two particles at rest at l is k a^2 / 15. The maximum attraction is k a / 8.
namespace vat {

/// Returns the force F(r) [N] for r < h; positive for repulsion.
inline Real layer_push(Real stiffness, Real width, Real threshold, Real distance) {
  const Real u = threshold - distance;
  return stiffness * u * u * (u * u - width * width) / (2 * width * width * width);
}

/// Returns the energy of two particles at the distance r < h, relative to that at r >= h [J].
inline Real layer_energy(Real stiffness, Real width, Real threshold, Real distance) {
  const Real u = threshold - distance;
  return stiffness * u * u * u * (u * u / 5 - width * width / 3) / (2 * width * width * width);
}

/// Returns the stiffness -F'(r) [N/m] for r < h.
inline Real layer_slope(Real stiffness, Real width, Real threshold, Real distance) {
  const Real u = threshold - distance;
  return stiffness * u * (2 * u * u - width * width) / (width * width * width);
}

/// Returns an upper bound of |F'| at all distances above r [N/m]. -F' increases as r decreases, and
/// is above -k / 3 for r > l.
inline Real greatest_layer_slope(Real stiffness, Real width, Real threshold, Real distance) {
  return std::max(stiffness, layer_slope(stiffness, width, threshold, distance));
}

}  // namespace vat
