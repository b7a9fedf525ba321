#pragma once

#include "core/forces/vat_motion.h"
#include "core/model/model.h"

/// What the stages of the weakly compressible liquid share.
namespace vat {

inline Vec3 nearest_image(const Model& model, const Vec3& x) {
  return model.periodic.any() ? model.periodic.nearest(x) : x;
}

/// The acceleration of free fall at a place, seen from the vat.
inline Vec3 fall_in_vat(const Model& model, const VatMotion& motion, const Vec3& position) {
  Vec3 fall = -motion.acceleration;
  if (!model.scene.forces.gravity) return fall;
  fall += model.scene.gravity;
  if (model.scene.central_field) {
    const CentralField& field = *model.scene.central_field;
    fall -= field.angular_frequency * field.angular_frequency * (position - field.center);
  }
  return fall;
}

/// 2 (d + 2) mu between two liquids: the harmonic mean, through which the slower one lets as much
/// through as the other (J. P. Morris, P. J. Fox, Y. Zhu, J. Comput. Phys. 136 (1997) 214, eq. 22).
inline Real mean_viscosity(const LiquidModel& a, const LiquidModel& b) {
  const Real sum = a.central_viscosity + b.central_viscosity;
  return sum > 0 ? 2 * a.central_viscosity * b.central_viscosity / sum : 0;
}

/// What two particles do to each other along x, over their volumes and |x|: pressure, and viscosity
/// 2 (d + 2) mu (v.x) / (x^2 + 0.01 h^2), which acts along x, so that it keeps angular momentum (J.
/// J. Monaghan, Rep. Prog. Phys. 68 (2005) 1703, sec. 4). `viscosity` has the factor.
inline Real central_force(const LiquidModel& liquid, Real viscosity, Real pressures,
                          const Vec3& velocity, const Vec3& x, Real r) {
  const Real h = liquid.support_radius;
  const Real viscous = viscosity * velocity.dot(x) / (r * r + Real{0.01} * h * h);
  return (viscous - pressures) * liquid.slope_scale * liquid.kernel.slope_over_r(r);
}

}  // namespace vat
