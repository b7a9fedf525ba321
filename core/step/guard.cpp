#include "core/step/guard.h"

#include <algorithm>

#include "core/limits.h"

namespace vat {
namespace {

/// Least distance at which particles meet walls.
Real wall_reach(const Model& model) {
  Real reach = kMaxLength;
  for (Index i = 0; i < model.particle_count; ++i) {
    const Real threshold = model.wall_laws[model.material[i]].threshold;
    reach = std::min(reach, threshold > 0 ? threshold : model.radius[i]);
  }
  return reach;
}

std::optional<GuardEvent::Cause> check(const Vec3& position, const Vec3& velocity,
                                       const GuardBounds& bounds) {
  if (!position.allFinite() || !velocity.allFinite()) return GuardEvent::Cause::non_finite;
  if ((position.array() < bounds.min.array()).any() ||
      (position.array() > bounds.max.array()).any()) {
    return GuardEvent::Cause::outside_domain;
  }
  if (velocity.squaredNorm() > bounds.max_speed * bounds.max_speed) {
    return GuardEvent::Cause::too_fast;
  }
  return {};
}

}  // namespace

GuardBounds guard_bounds(const Model& model, Real dt) {
  GuardBounds bounds{Vec3::Constant(-kMaxLength), Vec3::Constant(kMaxLength), kMaxSpeed};
  if (model.contact_reach > 0) bounds.max_speed = std::min(kMaxSpeed, model.contact_reach / dt);
  if (!model.scene.vat) return bounds;

  const Vat& vat = *model.scene.vat;
  const Real stroke = vat.motion ? vat.motion->stroke : 0;
  const Real side = (vat.max - vat.min).maxCoeff();
  bounds.min = (vat.min.array() - 2 * side - stroke).max(-kMaxLength);
  bounds.max = (vat.max.array() + 2 * side + stroke).min(kMaxLength);
  if (!vat.lid) bounds.max.z() = std::min(kMaxLength, vat.max.z() + 100 * side);
  bounds.max_speed = std::min(bounds.max_speed, wall_reach(model) / dt);
  return bounds;
}

std::optional<Fault> find_fault(const Model& model, const Configuration& at,
                                const GuardBounds& bounds) {
  for (Index i = 0; i < model.free_count; ++i) {
    if (const auto cause = check(at.position[i], at.velocity[i], bounds)) {
      const Index body = model.body[i];
      return Fault{*cause, body, i - model.bodies[body].particles.begin};
    }
  }
  for (std::size_t b = 0; b < at.rigid.size(); ++b) {
    const RigidModel& rigid = model.rigid_bodies[b];
    const Vec3 velocity = rigid.inverse_mass * at.rigid[b].momentum;
    if (const auto cause = check(at.rigid[b].center_of_mass, velocity, bounds)) {
      return Fault{*cause, rigid.body, 0};
    }
    if (!at.rigid[b].angular_momentum.allFinite() ||
        !at.rigid[b].orientation.coeffs().allFinite()) {
      return Fault{GuardEvent::Cause::non_finite, rigid.body, 0};
    }
  }
  return {};
}

}  // namespace vat
