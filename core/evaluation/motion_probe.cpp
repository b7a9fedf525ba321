#include "core/evaluation/motion_probe.h"

#include <algorithm>
#include <cmath>

#include "core/support/check.h"

namespace vat {
namespace {

constexpr Real kNoticed = 1e-9;  // in radii: shorter distances are rounding

/// sum m |v - mean|^2 over the particles of a body, with the vectors value(i).
template <class Value>
Real spread(const Model& model, const IndexRange& particles, Value&& value) {
  Vec3 mean = Vec3::Zero();
  Real mass = 0;
  for (Index i = particles.begin; i < particles.end; ++i) {
    mean += model.mass[i] * value(i);
    mass += model.mass[i];
  }
  mean /= mass;
  Real sum = 0;
  for (Index i = particles.begin; i < particles.end; ++i) {
    sum += model.mass[i] * (value(i) - mean).squaredNorm();
  }
  return sum;
}

}  // namespace

Real rate_of_motion(Real way2, Real change2, Real radius, Real mass) {
  const Real noticed = kNoticed * radius;
  return way2 > noticed * noticed * mass ? std::sqrt(std::sqrt(change2 / way2)) : 0;
}

void MotionProbe::begin(const State& state) {
  seen_ = 0;
  if (state.forces_current) see(state.now, state.forces);
}

void MotionProbe::see(const Configuration& at, const Forces& forces) {
  const bool is_first = seen_++ == 0;
  (is_first ? first_position_ : last_position_) = at.position;
  (is_first ? first_force_ : last_force_) = forces.particle;
}

Real MotionProbe::observed_rate(const Model& model) const {
  VAT_CHECK(seen_ < 2 || last_position_.size() == model.particle_count);
  if (seen_ < 2) return 0;
  Real greatest = 0;
  for (const ModelBody& body : model.bodies) {
    // The observed forces of bodies with implicit springs do not determine their motion either.
    if (body.kind == BodyKind::rigid || body.particles.begin >= model.implicit_begin) continue;
    const Real way = spread(model, body.particles,
                            [&](Index i) { return Vec3(last_position_[i] - first_position_[i]); });
    const Real change = spread(model, body.particles, [&](Index i) {
      return Vec3(model.inverse_mass[i] * (last_force_[i] - first_force_[i]));
    });
    const Real radius = model.radius[body.particles.begin];
    greatest = std::max(greatest, rate_of_motion(way, change, radius, body.mass));
  }
  return greatest;
}

}  // namespace vat
