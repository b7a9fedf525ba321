#pragma once

#include "core/simulation/simulation.h"

namespace vat::test {

/// Sums over all bodies.
struct Totals {
  Vec3 momentum = Vec3::Zero();          ///< [kg m/s]
  Vec3 angular_momentum = Vec3::Zero();  ///< about the origin [kg m^2/s]
};

inline Totals totals_of(const Diagnostics& diagnostics) {
  Totals totals;
  for (const BodyDiagnostics& body : diagnostics.bodies) {
    totals.momentum += body.linear_momentum;
    totals.angular_momentum += body.angular_momentum;
  }
  return totals;
}

/// Reference values for drifts of the totals: sums over all particles.
struct Motion {
  Real momentum = 0;          ///< of m |v| [kg m/s]
  Real angular_momentum = 0;  ///< of m |v| |x| [kg m^2/s]
};

inline Motion motion_of(const Simulation& simulation) {
  Motion motion;
  for (const BodyView& body : simulation.bodies()) {
    for (std::size_t i = 0; i < body.masses.size(); ++i) {
      const Real momentum = body.masses[i] * body.velocities[i].norm();
      motion.momentum += momentum;
      motion.angular_momentum += momentum * body.positions[i].norm();
    }
  }
  return motion;
}

}  // namespace vat::test
