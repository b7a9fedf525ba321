#include "core/contact/projection/projection.h"
#include "core/contact/scratch.h"

#include <algorithm>

#include "core/contact/projection/contact_solve.h"
#include "core/liquid/gas/liquid.h"
#include "core/state/kick_drift.h"
#include "core/state/rigid_motion.h"
#include "core/support/check.h"

namespace vat {
namespace {

void pose_bodies(const Model& model, Configuration& at) {
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    pose_rigid_body(model, model.rigid_bodies[b], at.rigid[b], at);
  }
}

VatMotion vat_at(const Model& model, Real time) {
  return model.scene.vat ? vat_motion(*model.scene.vat, time) : VatMotion{};
}

/// Updates the list of contacts at the configuration, with the margin of contacts.
void update_list(const ForceModel& f, Configuration& at, Real time) {
  ContactForceScratch& contact_buffers = f.work.of<ContactForceScratch>();
  if (f.model.contact_reach <= 0) return;
  Forces none;
  StepContext context{f.model, f.controls, time, f.step, at, none, f.work, f.runner};
  const Real slack = kContactMargin * f.model.contact_reach;
  if (contact_buffers.contacts.is_current(context, slack)) return;
  if (f.model.liquid_count > 0) sort_liquid(context);
  contact_buffers.contacts.update(context, slack);
}

constexpr Real kGapTolerance = 1e-6;  // in thresholds

/// Returns the part of a contact's overlap that the step does not remove [m]. It is below the
/// tolerance of the gaps and decreases by a hundredth in each step. Bodies that friction holds
/// could remove an overlap by a rounding error only with impulses that increase in each iteration,
/// up to the limit of friction.
Real remaining_overlap(const ContactConstraint& contact) {
  constexpr Real kKept = 0.99;
  const Real overlap = std::max(Real{0}, contact.threshold - contact.distance);
  return kKept * std::min(overlap, kGapTolerance * contact.threshold);
}

/// Gaps at the end of the step [m], from the predicted poses and the changes of velocities since.
struct Gaps {
  const Model& model;
  const VatMotion& vat;
  const Configuration& predicted;
  const Configuration& start;
  const std::vector<RigidMotion>& rigid;
  const std::vector<RigidMotion>& rigid_predicted;
  Real dt;

  Vec3 position(const ContactEnd& end) const {
    if (end.rigid == kNoParticle) {
      return start.position[end.particle] + dt * start.velocity[end.particle];
    }
    const RigidMotion& now = rigid[end.rigid];
    const RigidMotion& then = rigid_predicted[end.rigid];
    const Vec3& place = predicted.position[end.particle];
    const Vec3 arm = place - predicted.rigid[end.rigid].center_of_mass;
    return place + dt * (now.velocity - then.velocity + (now.spin - then.spin).cross(arm));
  }
  Real operator()(const ContactConstraint& contact) const {
    const Vec3 first = position(contact.ends[0]);
    if (contact.wall >= 0) {
      return wall_distance(*model.scene.vat, vat, contact.wall, first) - contact.threshold;
    }
    const Vec3 x = first - position(contact.ends[1]);
    return between(x).norm() - contact.threshold;
  }

  /// Sets the excess of a row to the gap, as a function of the velocities.
  void set_excess(const ContactConstraint& contact, SweepRow& row) const {
    row.kind = contact.wall >= 0 ? SweepRow::Excess::wall_gap : SweepRow::Excess::gap;
    row.required = contact.threshold - remaining_overlap(contact);
    for (const std::size_t k : {0U, 1U}) {
      const ContactEnd& end = contact.ends[k];
      if (end.rigid == kNoParticle) continue;
      row.sides[k].late_arm =
          predicted.position[end.particle] - predicted.rigid[end.rigid].center_of_mass;
    }
    const SweepRow::Side& first = row.sides[0];
    const Vec3 late = position(contact.ends[0]);
    row.start = -dt * first.velocity_at(first.late_arm);
    if (contact.wall >= 0) {
      row.start += wall_distance(*model.scene.vat, vat, contact.wall, late) * contact.normal;
    } else {
      const SweepRow::Side& second = row.sides[1];
      row.start +=
          between(late - position(contact.ends[1])) + dt * second.velocity_at(second.late_arm);
    }
  }

 private:
  Vec3 between(const Vec3& x) const { return model.periodic.any() ? model.periodic.nearest(x) : x; }
};

}  // namespace

void ContactProjection::predict(const ForceModel& f, Configuration& now, Real dt) {
  now = start_;
  vat::drift(f.model, f.runner, now, dt);
  pose_bodies(f.model, now);
  predicted_ = rigid_;
}

void ContactProjection::drift(const ForceModel& f, Configuration& now, Real time, Real dt) {
  // Further rounds are for rotations: the prediction is linear in the change of a rotation.
  constexpr int kMaxRounds = 4;
  const Model& model = f.model;
  start_ = now;
  VAT_CHECK(dt > 0 && now.rigid.size() == model.rigid_bodies.size());
  pose_bodies(model, start_);
  predict(f, now, dt);
  const VatMotion before = vat_at(model, time);
  VatMotion vat = vat_at(model, time + dt);
  update_list(f, now, time + dt);
  f.work.of<ContactForceScratch>().too_many_contacts = !search_.find(f, now, vat, constraints_);
  if (constraints_.empty()) return;

  VatMotion moving = before;
  moving.velocity = (vat.offset - before.offset) / dt;  // sticking contacts move as far as the wall
  ContactSolve solve{f, moving, start_, rigid_, dt};
  solve.set_geometry(now, constraints_);
  predicted_ = rigid_;
  for (ContactConstraint& contact : constraints_) {
    contact.approach = solve.slip(contact).dot(contact.normal);
  }
  recall(start_.contacts, constraints_);
  for (ContactConstraint& contact : constraints_) {
    if (contact.last.is_steady) solve.start_from(contact, dt * contact.last.drift);
  }
  const Gaps gap{model, vat, now, start_, rigid_, predicted_, dt};
  islands_.find(model, constraints_);
  for (int round = 0; round < kMaxRounds; ++round) {
    const bool is_solved = solve.sweep(
        constraints_, islands_, newton_,
        [&](const ContactConstraint& contact, SweepRow& row) { gap.set_excess(contact, row); });
    predict(f, now, dt);
    if (!is_solved) break;
    const bool is_met = std::ranges::all_of(constraints_, [&](const ContactConstraint& contact) {
      return gap(contact) >= -kGapTolerance * contact.threshold;
    });
    if (is_met) break;
  }
  for (ContactConstraint& contact : constraints_) contact.drift = contact.impulse();
}

void ContactProjection::finish(const ForceModel& f, Configuration& now, Real time, Real dt) {
  constexpr Real kTouching = 1e-3;  // in thresholds
  now.contacts.clear();
  if (constraints_.empty()) return;
  const Model& model = f.model;
  VAT_CHECK(dt > 0 && now.position.size() == model.particle_count);
  const VatMotion vat = vat_at(model, time + dt);
  pose_bodies(model, now);
  rigid_.resize(model.rigid_bodies.size());
  const Gaps gap{model, vat, now, now, rigid_, rigid_, 0};
  std::erase_if(constraints_, [&](const ContactConstraint& contact) {
    return contact.push == 0 && gap(contact) > kTouching * contact.threshold;
  });
  ContactSolve solve{f, vat, now, rigid_, dt};
  solve.set_geometry(now, constraints_);

  // The rebound that gravity causes in two steps counts as rest.
  const Real slow = model.scene.forces.gravity ? 2 * dt * model.scene.gravity.norm() : 0;
  for (ContactConstraint& contact : constraints_) {
    contact.friction_impulse -= contact.friction_impulse.dot(contact.normal) * contact.normal;
    contact.drift = contact.impulse();
    if (contact.last.is_steady) solve.start_from(contact, dt * contact.last.finish);
    const bool bounces = -contact.approach > slow;
    contact.parting = bounces ? -contact.restitution * contact.approach : 0;
  }
  islands_.find(model, constraints_);
  solve.sweep(constraints_, islands_, newton_, [](const ContactConstraint& contact, SweepRow& row) {
    row.required = contact.parting;
  });
  record(model, constraints_, dt, slow, is_hit_, now.contacts);
}

}  // namespace vat
