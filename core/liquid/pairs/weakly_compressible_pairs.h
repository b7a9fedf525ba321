#pragma once

#include <algorithm>

#include "core/laws/vat_motion.h"
#include "core/liquid/pairs/mirrors.h"
#include "core/model/model.h"
#include "core/neighbours/cell_sorted_points.h"
#include "core/stage/context.h"
#include "core/state/state.h"

/// Functions used by several stages of weakly compressible liquids.
namespace vat {

inline Vec3 nearest_image(const Model& model, const Vec3& x) {
  return model.periodic.any() ? model.periodic.nearest(x) : x;
}

/// Returns the acceleration of free fall at `position` in the frame of the vat [m/s^2].
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

/// Returns the pressure in units of rho_0 c^2 at the relative density s. For s <= 1.03, the
/// pressure is that of Tait's equation, (s^7 - 1) / 7. For 1.03 < s <= 2, the pressure is linear in
/// 1 / s. Only impacts compress a liquid beyond 1.03, with pressures rho c v of the chosen speed of
/// sound c. The stable step decreases with the density. With the part that is linear in 1 / s, the
/// stable step of a lattice is above 0.77 h / c up to s = 2, which is the limit in
/// find_step_limits(). With s^7, the stable step would be 0.62 h / c at s = 1.1. For s > 2, the
/// pressure follows the tangent at s = 2. With a pressure linear in 1 / s, which is bounded, a
/// liquid too soft for its weight would collapse.
inline Real tait_pressure(Real s) {
  constexpr Real kEnd = 1.03;
  constexpr Real kPressure = (kEnd * kEnd * kEnd * kEnd * kEnd * kEnd * kEnd - 1) / 7;
  constexpr Real kSlope = 0.9;
  constexpr Real kTwice = 2;
  if (s > kTwice) {
    return kPressure + kSlope * (1 / kEnd - 1 / kTwice + (s - kTwice) / (kTwice * kTwice));
  }
  if (s > kEnd) return kPressure + kSlope * (1 / kEnd - 1 / s);
  const Real s2 = s * s;
  return (s2 * s2 * s2 * s - 1) / 7;
}

/// Returns the minimum pressure of a liquid with a free surface at the relative density s [Pa].
inline Real least_pressure(const LiquidModel& liquid, Real s) {
  return 0 - liquid.tensile_strength * s * s;
}

inline bool has_solids(const Model& model) {
  return model.particle_count > model.liquid_count;
}

/// Returns the support radius, which is equal for all coupled liquids [m].
inline Real support_of(const Model& model) {
  return model.liquids[model.material[0]]->support_radius;
}

/// Returns the cell size for coupled liquids and solids in them [m]. At rest, a cell contains about
/// eight particles in three dimensions, and nine in two.
inline Real pair_cell_size(const Model& model) {
  const Real in_spacings = model.scene.dimensions == 3 ? 2 : 3;
  return in_spacings * model.liquids[model.material[0]]->spacing;
}

inline VatMotion motion_of(const StepContext& c) {
  return c.model.scene.vat ? vat_motion(*c.model.scene.vat, c.time) : VatMotion{};
}

/// Calls f(slot, x, mirror) for each image in walls within `radius` [m] of `place`. `slot` is the
/// slot of the reflected point, and x is the vector from the image to `place`.
template <class F>
void for_each_image(const Model& model, const VatMotion& motion, const CellSortedPoints& points,
                    const Vec3& place, Real radius, F&& f) {
  for_each_mirror(model, motion, place, radius, [&](const Mirror& mirror) {
    const Vec3 mirrored = mirror.place(place);
    model.periodic.for_each_image(mirrored, radius, [&](const Vec3& shift) {
      const Vec3 from = mirrored + shift;
      points.grid.for_each_run(from, radius, [&](Index begin, Index end) {
        for (Index slot = begin; slot < end; ++slot) {
          const Vec3 x(from.x() - points.x[slot], from.y() - points.y[slot],
                       from.z() - points.z[slot]);
          if (x.squaredNorm() < radius * radius) f(slot, mirror.turn(x), mirror);
        }
      });
    });
  });
}

/// Computes the pressure of images of particles near a position. A mirror conserves energy, but
/// reverses the component of gravity perpendicular to the wall. The pressure of an image therefore
/// includes the hydrostatic pressure difference between particle and image. At a free surface, this
/// correction is reduced for low pressures.
class ImagePressure {
 public:
  ImagePressure(const Model& model, const VatMotion& motion, const Vec3& place)
      : fall_(fall_in_vat(model, motion, place)),
        acceleration_(fall_.norm()),
        may_pull_(model.is_filled) {}

  Real operator()(const LiquidModel& liquid, Real pressure, const Vec3& position,
                  const Mirror& mirror) const {
    return near(liquid, pressure, mirror.place(position) - position);
  }
  /// Returns the pressure of an image [Pa]. `way` is the vector from the particle to the image [m].
  Real near(const LiquidModel& liquid, Real pressure, const Vec3& way) const {
    const Real more = liquid.rest_density * fall_.dot(way);
    if (may_pull_) return pressure + more;
    if (pressure <= 0) return pressure;
    // `layer` is the pressure under one layer of particles.
    const Real layer = liquid.rest_density * acceleration_ * liquid.spacing;
    return std::max(Real{0}, pressure + pressure / (pressure + layer) * more);
  }

 private:
  Vec3 fall_;
  Real acceleration_;
  bool may_pull_;
};

}  // namespace vat
