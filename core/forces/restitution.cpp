#include "core/forces/restitution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/forces/pair_direction.h"
#include "core/forces/vat_motion.h"
#include "core/rigid/rigid_motion.h"
#include "core/step/workspace.h"

namespace vat {

Real restitution_of(Real damping_ratio) {
  const Real zeta = damping_ratio;
  const Real s2 = (1 - zeta) * (1 + zeta);
  if (std::abs(s2) < 1e-8) return std::exp(Real{-2});  // the limit of both
  const Real s = std::sqrt(std::abs(s2));
  if (zeta > 1) return std::exp(-zeta / s * std::log((zeta + s) / (zeta - s)));
  return std::exp(-zeta / s * (std::numbers::pi - std::atan2(2 * zeta * s, 1 - 2 * zeta * zeta)));
}

/// By bisection: e falls as zeta grows, and is about 1 / (4 zeta^2) where that is large.
Real damping_ratio_for(Real restitution) {
  if (restitution >= 1) return 0;
  Real low = 0;
  Real high = 1 + 1 / std::sqrt(restitution);
  for (int halving = 0; halving < 60; ++halving) {
    const Real middle = (low + high) / 2;
    (restitution_of(middle) > restitution ? low : high) = middle;
  }
  return high;
}

Real damping_for(Real damping_ratio, Real stiffness, Real yielding) {
  return yielding > 0 ? 2 * damping_ratio * std::sqrt(stiffness / yielding) : 0;
}

namespace {

Vec3 sum_directions(const StepContext& c, const VatMotion& motion, Index i) {
  const Model& model = c.model;
  Vec3 sum = Vec3::Zero();
  if (model.contact_reach > 0) {
    c.work.contacts.for_each(model, c.configuration, i, [&](const Contact& contact) {
      if (contact.stiffness == 0) return;
      sum += pair_direction(contact.x, contact.distance, i, contact.other, model.scene.dimensions);
    });
  }
  const ContactLaw& law = model.wall_laws[model.material[i]];
  if (model.walls.empty() || law.stiffness == 0) return sum;
  const Real threshold = law.wall_threshold(model.radius[i]);
  for (const int wall : model.walls) {
    const Vec3& position = c.configuration.position[i];
    if (wall_distance(*model.scene.vat, motion, wall, position) < threshold) {
      sum += wall_normal(wall);
    }
  }
  return sum;
}

void spread_over_body(StepContext& c, std::size_t body) {
  const RigidModel& rigid = c.model.rigid_bodies[body];
  const RigidState& state = c.configuration.rigid[body];
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
  for (Index i = rigid.particles.begin; i < rigid.particles.end; ++i) {
    force += c.work.yieldings[i];
    torque += (c.configuration.position[i] - state.center_of_mass).cross(c.work.yieldings[i]);
  }
  const Vec3 linear = rigid.inverse_mass * force;
  const Vec3 angular = angular_velocity(rigid, state.orientation, torque);
  for (Index i = rigid.particles.begin; i < rigid.particles.end; ++i) {
    c.work.yieldings[i] =
        linear + angular.cross(c.configuration.position[i] - state.center_of_mass);
  }
}

}  // namespace

void find_yieldings(StepContext& c) {
  const Model& model = c.model;
  const VatMotion motion = model.walls.empty() ? VatMotion{} : vat_motion(*model.scene.vat, c.time);
  c.work.yieldings.resize(model.particle_count);
  for_blocks(c.runner, model.particle_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto i = static_cast<Index>(k);
      const Vec3 sum = sum_directions(c, motion, i);
      c.work.yieldings[i] = i < model.free_count ? Vec3(model.inverse_mass[i] * sum) : sum;
    }
  });
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    const IndexRange particles = model.rigid_bodies[b].particles;
    if (model.rigid_bodies[b].is_held(c.step)) {
      std::fill_n(c.work.yieldings.begin() + particles.begin, particles.size(), Vec3::Zero());
    } else {
      spread_over_body(c, b);
    }
  }
}

Real Yieldings::along(Index i, const Vec3& normal) const {
  const Real shared = normal.dot(work.yieldings[i]);
  if (i < model.free_count) return std::max(shared, model.inverse_mass[i]);
  const Index body = model.bodies[model.body[i]].rigid;
  const RigidModel& rigid = model.rigid_bodies[body];
  if (rigid.is_held(step)) return 0;
  const RigidState& state = at.rigid[body];
  const Vec3 lever = (at.position[i] - state.center_of_mass).cross(normal);
  const Real own =
      rigid.inverse_mass + lever.dot(angular_velocity(rigid, state.orientation, lever));
  return std::max(shared, own);
}

Real Yieldings::wall_damping(Index i, const Vec3& normal) const {
  const ContactLaw& law = model.wall_laws[model.material[i]];
  if (law.damping_ratio == 0) return law.damping;
  return damping_for(law.damping_ratio, law.stiffness, along(i, normal));
}

}  // namespace vat
