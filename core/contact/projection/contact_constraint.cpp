#include "core/contact/projection/contact_constraint.h"
#include "core/contact/scratch.h"

#include <algorithm>
#include <utility>

#include "core/limits.h"
#include "core/support/check.h"

namespace vat {

RigidMotion rigid_motion(const RigidModel& rigid, const RigidState& state, bool is_held) {
  const Mat3 r = state.orientation.normalized().toRotationMatrix();
  const Mat3 inverse_inertia = r * rigid.inverse_inertia * r.transpose();
  return {rigid.inverse_mass * state.momentum, inverse_inertia * state.angular_momentum,
          is_held ? Mat3(Mat3::Zero()) : inverse_inertia, is_held ? 0 : rigid.inverse_mass};
}

namespace {

ContactEnd make_end(const ForceModel& f, Index particle) {
  const Model& model = f.model;
  ContactEnd end;
  end.particle = particle;
  if (particle < model.free_count) {
    end.inverse_mass = model.inverse_mass[particle];
    return end;
  }
  end.rigid = model.bodies[model.body[particle]].rigid;
  const RigidModel& rigid = model.rigid_bodies[end.rigid];
  end.inverse_mass = rigid.is_held(f.step) ? 0 : rigid.inverse_mass;
  return end;
}

void find_walls(const ForceModel& f, const Configuration& at, const VatMotion& vat, Index i,
                std::vector<ContactConstraint>& found) {
  const Model& model = f.model;
  const ContactLaw& law = model.wall_laws[model.material[i]];
  if (!law.is_projected || (model.is_coupled && i < model.liquid_count)) return;
  const ContactEnd end = make_end(f, i);
  if (end.inverse_mass == 0) return;
  const Real threshold = law.wall_threshold(model.radius[i]);
  for (const int wall : model.walls) {
    const Real distance = wall_distance(*model.scene.vat, vat, wall, at.position[i]);
    if (distance > (1 + kContactMargin) * threshold) continue;
    found.push_back({.ends = {end, ContactEnd{}},
                     .wall = wall,
                     .threshold = threshold,
                     .friction = law.friction,
                     .restitution = law.restitution});
  }
}

void find_pairs(const ForceModel& f, const Configuration& at, Index i,
                std::vector<ContactConstraint>& found) {
  const Model& model = f.model;
  if (model.contact_reach <= 0) return;
  const auto take = [&](const Contact& contact) {
    if (contact.other < i || model.body[contact.other] == model.body[i]) return;
    const ContactLaw& law = model.contact_law(model.material[i], model.material[contact.other]);
    if (!law.is_projected || contact.distance > (1 + kContactMargin) * contact.threshold) return;
    const ContactConstraint constraint{.ends = {make_end(f, i), make_end(f, contact.other)},
                                       .threshold = contact.threshold,
                                       .friction = law.friction,
                                       .restitution = law.restitution};
    if (constraint.ends[0].inverse_mass + constraint.ends[1].inverse_mass > 0) {
      found.push_back(constraint);
    }
  };
  f.work.of<ContactForceScratch>().contacts.for_each(model, at, i, take,
                                                     kContactMargin * model.contact_reach);
}

}  // namespace

void recall(const std::vector<ContactImpulse>& last, std::vector<ContactConstraint>& constraints) {
  auto next = last.begin();
  for (ContactConstraint& contact : constraints) {
    const auto key = std::pair(contact.ends[0].particle, contact.other());
    while (next != last.end() && std::pair(next->particle, next->other) < key) ++next;
    if (next == last.end() || std::pair(next->particle, next->other) != key) continue;
    contact.last = *next;
    contact.is_new = false;
  }
}

void record(const Model& model, const std::vector<ContactConstraint>& constraints, Real dt,
            Real slow, std::vector<std::uint8_t>& is_hit, std::vector<ContactImpulse>& contacts) {
  VAT_CHECK(dt > 0);
  constexpr Real kSteady = 2;
  is_hit.assign(model.free_count + model.rigid_bodies.size(), 0);
  const auto any_end = [&](const ContactConstraint& contact, auto&& f) {
    return std::ranges::any_of(contact.ends, [&](const ContactEnd& end) {
      if (end.inverse_mass == 0) return false;
      const std::size_t n =
          end.rigid == kNoParticle ? end.particle : std::size_t{model.free_count} + end.rigid;
      return f(is_hit[n]);
    });
  };
  for (const ContactConstraint& contact : constraints) {
    if (-contact.approach <= slow) continue;
    any_end(contact, [](std::uint8_t& is_end_hit) {
      is_end_hit = 1;
      return false;
    });
  }
  contacts.clear();
  for (const ContactConstraint& contact : constraints) {
    const Vec3 drift = contact.drift / dt;
    const Vec3 finish = (contact.impulse() - contact.drift) / dt;
    const ContactImpulse& last = contact.last;
    const bool is_steady =
        !any_end(contact, [](std::uint8_t is_end_hit) { return is_end_hit != 0; }) ||
        (drift.norm() <= kSteady * last.drift.norm() &&
         finish.norm() <= kSteady * last.finish.norm());
    contacts.push_back({contact.ends[0].particle, contact.other(), drift, finish, is_steady});
  }
}

bool ConstraintSearch::find(const ForceModel& f, const Configuration& at, const VatMotion& vat,
                            std::vector<ContactConstraint>& constraints) {
  constraints.clear();
  // Checked before memory for all of them is allocated.
  if (f.model.contact_reach > 0 &&
      f.work.of<ContactForceScratch>().contacts.size() > 4 * kMaxProjections)
    return false;
  blocks_.resize(block_count(f.model.particle_count));
  for_blocks(f.runner, f.model.particle_count, [&](std::size_t begin, std::size_t end) {
    std::vector<ContactConstraint>& found = blocks_[begin / kBlockSize];
    found.clear();
    for (std::size_t i = begin; i < end; ++i) {
      find_walls(f, at, vat, static_cast<Index>(i), found);
      find_pairs(f, at, static_cast<Index>(i), found);
    }
  });
  std::size_t count = 0;
  for (const std::vector<ContactConstraint>& found : blocks_) count += found.size();
  if (count > kMaxProjections) return false;
  for (const std::vector<ContactConstraint>& found : blocks_) {
    constraints.insert(constraints.end(), found.begin(), found.end());
  }
  return true;
}

}  // namespace vat
