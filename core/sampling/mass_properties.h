#pragma once

#include "core/sampling/sampling.h"
#include "core/types.h"

namespace vat {

struct MassProperties {
  Real mass = 0;        ///< M = sum m_e [kg]
  Vec3 center_of_mass;  ///< r_cm [m]
  Mat3 inertia;         ///< about r_cm [kg m^2]
};

/// I = sum m_e ((x.x) 1 - x x^T) + 2/5 m_e r_e^2 1: the last term is each particle's own as a solid
/// sphere, and keeps single and collinear particles from a singular tensor.
MassProperties mass_properties(const SampledBody& body);

/// The same of a body in the plane y = 0, of discs: I = sum m_e (x.x + r_e^2 / 2), about y. It is
/// put about every axis: none but y is ever turned about, and a body whose moments are equal stays
/// in the plane to the bit.
MassProperties plane_mass_properties(const SampledBody& body);

}  // namespace vat
