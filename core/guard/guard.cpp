#include "core/guard/guard.h"

#include <algorithm>
#include <array>
#include <atomic>

#include "core/limits.h"
#include "core/state/rigid_motion.h"
#include "core/support/check.h"

namespace vat {
namespace {

Real least_radius(const Model& model, const ModelBody& body) {
  Real least = kMaxLength;
  for (Index i = body.particles.begin; i < body.particles.end; ++i) {
    least = std::min(least, model.radius[i]);
  }
  return least;
}

/// Bodies that interact with another one in the same way, except for their radii.
struct AlikeBodies {
  std::size_t count = 0;
  Real least_radius = kMaxLength;
};

/// By material, for solids and for liquids. Liquids do not touch liquids of their material.
std::array<std::vector<AlikeBodies>, 2> bodies_by_material(const Model& model) {
  std::array<std::vector<AlikeBodies>, 2> result;
  result.fill(std::vector<AlikeBodies>(model.scene.materials.size()));
  for (const ModelBody& body : model.bodies) {
    AlikeBodies& alike = result[body.kind == BodyKind::liquid][body.material];
    ++alike.count;
    alike.least_radius = std::min(alike.least_radius, least_radius(model, body));
  }
  return result;
}

Real travel_of(const Model& model, const ModelBody& body,
               const std::array<std::vector<AlikeBodies>, 2>& bodies) {
  if (model.is_coupled && body.kind == BodyKind::liquid) {
    return model.liquids[body.material]->support_radius / 2;  // pairs repel from this distance on
  }
  const Real radius = least_radius(model, body);
  Real travel = kMaxLength;
  const auto notice = [&](const ContactLaw& law, Real touch) {
    if (law.stiffness == 0 && !law.is_projected) return;
    travel = std::min(travel, law.threshold > 0 ? law.threshold : touch);
  };
  const bool is_liquid = body.kind == BodyKind::liquid;
  for (const bool of_liquids : {false, true}) {
    for (Index other = 0; other < bodies[of_liquids].size(); ++other) {
      const bool is_alike = other == body.material && of_liquids == is_liquid;
      const AlikeBodies& others = bodies[of_liquids][other];
      if ((is_alike && is_liquid) || others.count <= (is_alike ? 1U : 0U)) continue;
      notice(model.contact_law(body.material, other), radius + others.least_radius);
    }
  }
  if (body.kind == BodyKind::deformable && model.self_contacts[body.material]) {
    travel = std::min(travel, 2 * radius);
  }
  if (model.scene.vat) notice(model.wall_laws[body.material], radius);
  return travel;
}

Real extent_of(const Model& model, const RigidModel& rigid) {
  Real extent = 0;
  for (Index i = rigid.particles.begin; i < rigid.particles.end; ++i) {
    extent = std::max(extent, model.local_position[i - model.free_count].norm());
  }
  return extent;
}

Vec3 half_sizes_of(const Model& model, const RigidModel& rigid) {
  Vec3 half = Vec3::Zero();
  for (Index i = rigid.particles.begin; i < rigid.particles.end; ++i) {
    half = half.cwiseMax(model.local_position[i - model.free_count].cwiseAbs());
  }
  return half;
}

bool is_inside(const Vec3& position, const GuardBounds& bounds) {
  return (position.array() >= bounds.min.array()).all() &&
         (position.array() <= bounds.max.array()).all();
}

/// The cause of a fault: out of bounds, or not a number.
GuardEvent::Cause cause_of(const Vec3& position, const Vec3& velocity, const GuardBounds& bounds) {
  if (!position.allFinite() || !velocity.allFinite()) return GuardEvent::Cause::non_finite;
  if (!is_inside(position, bounds)) return GuardEvent::Cause::outside_domain;
  return GuardEvent::Cause::too_fast;
}

std::optional<Fault> find_free_fault(const ModelBody& body, Index index, const Configuration& at,
                                     const GuardBounds& bounds, Real max_speed,
                                     TaskRunner* runner) {
  const std::size_t count = body.particles.size();
  std::atomic<std::size_t> first = count;  // first particle with a fault
  for_blocks(runner, count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = body.particles.begin + k;
      // In this form, a NaN fails.
      if (is_inside(at.position[i], bounds) &&
          at.velocity[i].squaredNorm() <= max_speed * max_speed) {
        continue;
      }
      std::size_t known = first;
      while (k < known && !first.compare_exchange_weak(known, k)) {
      }
      return;
    }
  });
  if (first == count) return {};
  const std::size_t i = body.particles.begin + first;
  return Fault{cause_of(at.position[i], at.velocity[i], bounds), index, static_cast<Index>(first)};
}

std::optional<Fault> find_rigid_fault(const RigidModel& rigid, const RigidState& state, Real extent,
                                      const GuardBounds& bounds, Real max_speed, Real dt) {
  const Vec3 velocity = rigid.inverse_mass * state.momentum;
  const Vec3 omega = angular_velocity(rigid, state.orientation, state.angular_momentum);
  const bool is_slow =
      velocity.norm() + extent * omega.norm() <= max_speed && omega.norm() * dt <= 1;
  if (is_slow && is_inside(state.center_of_mass, bounds)) return {};
  return Fault{cause_of(state.center_of_mass, velocity + omega, bounds), rigid.body, 0};
}

}  // namespace

GuardBounds guard_bounds(const Model& model) {
  GuardBounds bounds{Vec3::Constant(-kMaxLength), Vec3::Constant(kMaxLength), {}, {}, {}};
  const auto bodies = bodies_by_material(model);
  for (const ModelBody& body : model.bodies) {
    bounds.travel.push_back(travel_of(model, body, bodies));
  }
  for (const RigidModel& rigid : model.rigid_bodies) {
    bounds.extent.push_back(extent_of(model, rigid));
    bounds.half_sizes.push_back(half_sizes_of(model, rigid));
  }
  if (!model.scene.vat) return bounds;

  const Vat& vat = *model.scene.vat;
  const Real stroke = vat.motion ? vat.motion->stroke : 0;
  const Real side = (vat.max - vat.min).maxCoeff();
  bounds.min = (vat.min.array() - 2 * side - stroke).max(-kMaxLength);
  bounds.max = (vat.max.array() + 2 * side + stroke).min(kMaxLength);
  if (!vat.lid) bounds.max.z() = std::min(kMaxLength, vat.max.z() + 100 * side);
  for (int axis = 0; axis < 3; ++axis) {
    if (std::ranges::find(model.walls, 2 * axis) != model.walls.end()) continue;
    bounds.min[axis] = -kMaxLength;
    bounds.max[axis] = kMaxLength;
  }
  return bounds;
}

std::optional<Fault> find_fault(const Model& model, const Configuration& at,
                                const GuardBounds& bounds, Real dt, TaskRunner* runner) {
  for (Index b = 0; b < model.bodies.size(); ++b) {
    VAT_CHECK(bounds.travel.size() == model.bodies.size() && dt > 0);
    const ModelBody& body = model.bodies[b];
    const Real max_speed = std::min(kMaxSpeed, bounds.travel[b] / dt);
    const auto fault = body.kind == BodyKind::rigid
                           ? find_rigid_fault(model.rigid_bodies[body.rigid], at.rigid[body.rigid],
                                              bounds.extent[body.rigid], bounds, max_speed, dt)
                           : find_free_fault(body, b, at, bounds, max_speed, runner);
    if (fault) return fault;
  }
  return {};
}

}  // namespace vat
