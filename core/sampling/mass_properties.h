#pragma once

#include "core/sampling/sampling.h"
#include "core/types.h"

namespace vat {

struct MassProperties {
  Real mass = 0;        ///< M = sum m_e [kg]
  Vec3 center_of_mass;  ///< r_cm [m]
  Mat3 inertia;         ///< about the centre of mass [kg m^2]
};

/// Returns the mass properties of a body, with I = sum m_e ((x.x) 1 - x x^T) + 2/5 m_e r_e^2 1. The
/// last term is the inertia of the particles as solid spheres. This term makes the tensor of single
/// and collinear particles invertible.
MassProperties mass_properties(const SampledBody& body);

/// Returns the mass properties of discs in the plane y = 0. The moment about y is I = sum m_e (x.x
/// + r_e^2 / 2). All three moments have this value, so that rounding does not move the body out of
/// the plane.
MassProperties plane_mass_properties(const SampledBody& body);

}  // namespace vat
