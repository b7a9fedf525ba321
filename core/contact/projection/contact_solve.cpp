#include "core/contact/projection/contact_solve.h"

#include <algorithm>

#include "core/laws/pair_direction.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// The vector from the second end's particle to the first one; in a periodic world to its nearest
/// image.
Vec3 between(const Model& model, const Configuration& at, const ContactConstraint& contact) {
  const Vec3 x = at.position[contact.ends[0].particle] - at.position[contact.ends[1].particle];
  return model.periodic.any() ? model.periodic.nearest(x) : x;
}

}  // namespace

/// Sets both arms to one point between the particles, or at the wall.
void ContactSolve::set_arms(ContactConstraint& contact, Real distance) const {
  auto& [first, second] = contact.ends;
  Real share = 1;  // of the distance, from the first end
  if (first.rigid == kNoParticle) {
    share = 0;
  } else if (second.rigid != kNoParticle) {
    const Real own = model().radius[first.particle];
    share = own / (own + model().radius[second.particle]);
  }
  const auto set = [&](ContactEnd& end, Real way) {
    if (end.rigid == kNoParticle) return;
    end.arm = at.position[end.particle] - at.rigid[end.rigid].center_of_mass +
              way * distance * contact.normal;
  };
  set(first, -share);
  set(second, 1 - share);
}

void ContactSolve::set_geometry(const Configuration& predicted,
                                std::vector<ContactConstraint>& constraints) {
  VAT_CHECK(dt > 0 && at.rigid.size() == model().rigid_bodies.size());
  // At larger angles the ends pass each other, and the predicted normal is used.
  constexpr Real kMinCosine = 0.5;
  rigid.resize(at.rigid.size());
  for (std::size_t b = 0; b < rigid.size(); ++b) {
    const RigidModel& body = model().rigid_bodies[b];
    const bool is_held = body.is_held(force_model.step) || body.axle;
    rigid[b] = rigid_motion(body, at.rigid[b], is_held);
  }
  for (ContactConstraint& contact : constraints) {
    const ContactEnd& first = contact.ends[0];
    const ContactEnd& second = contact.ends[1];
    Real distance = 0;
    if (contact.wall >= 0) {
      contact.normal = wall_normal(contact.wall);
      distance = wall_distance(*model().scene.vat, vat, contact.wall, at.position[first.particle]);
    } else {
      const Vec3 x = between(model(), at, contact);
      const Vec3 later = between(model(), predicted, contact);
      const int dimensions = model().scene.dimensions;
      const auto direction = [&](const Vec3& way) {
        return pair_direction(way, way.norm(), first.particle, second.particle, dimensions);
      };
      distance = x.norm();
      contact.normal = direction(x);
      if (contact.normal.dot(direction(later)) < kMinCosine) contact.normal = direction(later);
    }
    set_arms(contact, distance);
    contact.mobility = mobility(first, contact.normal) + mobility(second, contact.normal);
  }
}

Vec3 ContactSolve::velocity(const ContactEnd& end) const {
  if (end.rigid == kNoParticle) return at.velocity[end.particle];
  return rigid[end.rigid].velocity + rigid[end.rigid].spin.cross(end.arm);
}

Real ContactSolve::mobility(const ContactEnd& end, const Vec3& direction) const {
  if (end.rigid == kNoParticle) return end.inverse_mass;
  const Vec3 lever = end.arm.cross(direction);
  return end.inverse_mass + lever.dot(rigid[end.rigid].inverse_inertia * lever);
}

void ContactSolve::apply(const ContactEnd& end, const Vec3& impulse) {
  if (end.inverse_mass == 0) return;
  VAT_CHECK(end.rigid == kNoParticle || end.rigid < rigid.size());
  if (end.rigid == kNoParticle) {
    at.velocity[end.particle] += end.inverse_mass * impulse;
    return;
  }
  const Vec3 turning = end.arm.cross(impulse);
  at.rigid[end.rigid].momentum += impulse;
  at.rigid[end.rigid].angular_momentum += turning;
  RigidMotion& motion = rigid[end.rigid];
  motion.velocity += end.inverse_mass * impulse;
  motion.spin += motion.inverse_inertia * turning;
}

Vec3 ContactSolve::slip(const ContactConstraint& contact) const {
  if (contact.wall < 0) return velocity(contact.ends[0]) - velocity(contact.ends[1]);
  const Wall& wall = model().scene.vat->walls[static_cast<std::size_t>(contact.wall)];
  return velocity(contact.ends[0]) - vat.velocity - wall.velocity;
}

/// The extrapolated impulses may violate the constraints; the next sweep corrects them.
Real ContactSolve::extrapolate(std::vector<ContactConstraint>& constraints,
                               std::span<const Index> island, Real last) {
  Real size = 0;
  for (const Index c : island) {
    ContactConstraint& contact = constraints[c];
    contact.gradient += contact.impulse();
    size += contact.gradient.squaredNorm();
  }
  const Real share = size < last ? size / last : 0;
  for (const Index c : island) {
    ContactConstraint& contact = constraints[c];
    const Vec3 impulse = share * contact.direction;
    const Real along = impulse.dot(contact.normal);
    contact.push += along;
    contact.friction_impulse += impulse - along * contact.normal;
    apply(contact.ends[0], impulse);
    apply(contact.ends[1], -impulse);
    contact.direction = impulse + contact.gradient;
  }
  return size;
}

void ContactSolve::start_from(ContactConstraint& contact, const Vec3& impulse) {
  const Vec3 before = contact.impulse();
  const Vec3 whole = before + impulse;
  contact.push = std::max(Real{0}, whole.dot(contact.normal));
  contact.friction_impulse = whole - whole.dot(contact.normal) * contact.normal;
  const Real limit = contact.friction * contact.push;
  const Real size = contact.friction_impulse.norm();
  if (size > limit) contact.friction_impulse *= limit / size;
  apply(contact.ends[0], contact.impulse() - before);
  apply(contact.ends[1], before - contact.impulse());
}

Real ContactSolve::push(ContactConstraint& contact, Real change) {
  if (change == 0) return 0;
  const Vec3 impulse = change * contact.normal;
  contact.push += change;
  apply(contact.ends[0], impulse);
  apply(contact.ends[1], -impulse);
  return dt * contact.mobility * std::abs(change) / contact.threshold;
}

Real ContactSolve::apply_friction(ContactConstraint& contact) {
  const Real limit = contact.friction * contact.push;
  if (limit == 0 && contact.friction_impulse.isZero(0)) return 0;
  const Vec3 velocity = slip(contact);
  const Vec3 across = velocity - velocity.dot(contact.normal) * contact.normal;
  const Real speed = across.norm();
  const Vec3 direction = speed > 0 ? Vec3(across / speed) : Vec3(Vec3::Zero());
  const Real yields = mobility(contact.ends[0], direction) + mobility(contact.ends[1], direction);
  Vec3 wanted = contact.friction_impulse;
  if (speed > 0) wanted -= across / yields;
  const Real size = wanted.norm();
  if (size > limit) wanted *= limit / size;
  const Vec3 impulse = wanted - contact.friction_impulse;
  contact.friction_impulse = wanted;
  apply(contact.ends[0], impulse);
  apply(contact.ends[1], -impulse);
  return dt * contact.mobility * impulse.norm() / contact.threshold;
}

}  // namespace vat
