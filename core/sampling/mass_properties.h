#pragma once

#include "core/sampling/sampling.h"
#include "core/types.h"

namespace vat {

struct MassProperties {
  Real mass = 0;        ///< M = sum m_e [kg]
  Vec3 center_of_mass;  ///< r_cm [m]
  Mat3 inertia;         ///< about r_cm [kg m^2]
};

/// I = sum m_e ((x.x) 1 - x x^T) + 2/5 m_e r_e^2 1. The last term is the inertia of the particles
/// as solid spheres, which makes the tensor of single and collinear particles invertible.
MassProperties mass_properties(const SampledBody& body);

/// Mass properties of discs in the plane y = 0: I = sum m_e (x.x + r_e^2 / 2), about y. All three
/// moments have this value: the body only rotates about y, and with equal moments it stays in the
/// plane exactly.
MassProperties plane_mass_properties(const SampledBody& body);

}  // namespace vat
