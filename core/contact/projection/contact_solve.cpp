#include "core/contact/projection/contact_solve.h"

#include <algorithm>
#include <atomic>

#include "core/contact/projection/cross_matrix.h"
#include "core/contact/projection/sweep_progress.h"
#include "core/laws/pair_direction.h"
#include "core/support/check.h"
#include "core/support/parallel.h"

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
    contact.distance = distance;
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

void ContactSolve::add_momentum(const ContactEnd& end, const Vec3& impulse) const {
  if (end.inverse_mass == 0 || end.rigid == kNoParticle) return;
  at.rigid[end.rigid].momentum += impulse;
  at.rigid[end.rigid].angular_momentum += end.arm.cross(impulse);
}

void ContactSolve::apply(const ContactEnd& end, const Vec3& impulse) {
  if (end.inverse_mass == 0) return;
  VAT_CHECK(end.rigid == kNoParticle || end.rigid < rigid.size());
  if (end.rigid == kNoParticle) {
    at.velocity[end.particle] += end.inverse_mass * impulse;
    return;
  }
  add_momentum(end, impulse);
  RigidMotion& motion = rigid[end.rigid];
  motion.velocity += end.inverse_mass * impulse;
  motion.spin += motion.inverse_inertia * end.arm.cross(impulse);
}

Vec3 ContactSolve::slip(const ContactConstraint& contact) const {
  if (contact.wall < 0) return velocity(contact.ends[0]) - velocity(contact.ends[1]);
  return velocity(contact.ends[0]) - wall_velocity(contact);
}

Vec3 ContactSolve::wall_velocity(const ContactConstraint& contact) const {
  if (contact.wall < 0) return Vec3::Zero();
  const Wall& wall = model().scene.vat->walls[static_cast<std::size_t>(contact.wall)];
  return vat.velocity + wall.velocity;
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

SweepRow ContactSolve::make_row(const ContactConstraint& contact) const {
  SweepRow row{.sides = {},
               .normal = contact.normal,
               .wall_velocity = wall_velocity(contact),
               .mobility = Mat3::Zero(),
               .normal_mobility = Vec3::Zero(),
               .inverse_mobility = 1 / contact.mobility,
               .scale = dt * contact.mobility / contact.threshold,
               .friction = contact.friction,
               .dt = dt,
               .push = contact.push,
               .friction_impulse = contact.friction_impulse,
               .gradient = Vec3::Zero()};
  for (const std::size_t k : {0U, 1U}) {
    const ContactEnd& end = contact.ends[k];
    SweepRow::Side& side = row.sides[k];
    if (end.particle == kNoParticle) continue;
    side.inverse_mass = end.inverse_mass;
    row.mobility.diagonal().array() += end.inverse_mass;
    if (end.rigid == kNoParticle) {
      side.velocity = &at.velocity[end.particle];
      continue;
    }
    RigidMotion& motion = rigid[end.rigid];
    side.velocity = &motion.velocity;
    side.spin = &motion.spin;
    side.inverse_inertia = &motion.inverse_inertia;
    side.arm = end.arm;
    const Mat3 cross = cross_matrix(end.arm);
    row.mobility -= cross * motion.inverse_inertia * cross;
  }
  row.normal_mobility = row.mobility * row.normal;
  return row;
}

void ContactSolve::store(const SweepRow& row, ContactConstraint& contact) const {
  const Vec3 change = row.impulse() - contact.impulse();
  contact.push = row.push;
  contact.friction_impulse = row.friction_impulse;
  add_momentum(contact.ends[0], change);
  add_momentum(contact.ends[1], -change);
}

namespace {

/// The extrapolated impulses may violate the constraints; the next sweep corrects them. Returns the
/// squared norm of the gradients [N^2 s^2]. `last` is the result after the preceding sweeps, or 0
/// after the first ones.
Real extrapolate(std::span<SweepRow> rows, Real last) {
  Real size = 0;
  for (SweepRow& row : rows) {
    row.gradient += row.impulse();
    size += row.gradient.squaredNorm();
  }
  const Real share = size < last ? size / last : 0;
  for (SweepRow& row : rows) {
    const Vec3 impulse = share * row.direction;
    row.direction = impulse + row.gradient;
    if (share == 0) continue;
    const Real along = impulse.dot(row.normal);
    row.push += along;
    row.friction_impulse += impulse - along * row.normal;
    row.apply(impulse);
  }
  return size;
}

/// Relaxes the rows in order and in reverse order. Returns the greatest displacement of the ends of
/// a contact, in thresholds.
Real relax(std::span<SweepRow> rows) {
  for (SweepRow& row : rows) row.gradient = -row.impulse();
  Real greatest = 0;
  for (SweepRow& row : rows) greatest = std::max(greatest, row.relax());
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
    greatest = std::max(greatest, row->relax());
  }
  return greatest;
}

/// Returns whether the contacts are new or most of them are steady.
bool is_steady(std::span<const ContactConstraint> constraints, std::span<const Index> island) {
  constexpr std::ptrdiff_t kMost = 10;  // all but one of so many
  const auto steady =
      std::ranges::count_if(island, [&](Index c) { return constraints[c].last.is_steady; });
  return kMost * steady >= (kMost - 1) * std::ssize(island) ||
         std::ranges::all_of(island, [&](Index c) { return constraints[c].is_new; });
}

void raise(std::atomic<std::size_t>& greatest, std::size_t value) {
  std::size_t known = greatest;
  while (known < value && !greatest.compare_exchange_weak(known, value)) {
  }
}

}  // namespace

ContactSolve::IslandResult ContactSolve::sweep_island(
    std::vector<ContactConstraint>& constraints, std::span<const Index> island, std::size_t most,
    ContactNewtonScratch& scratch, std::size_t block, const SetExcess& set_excess) {
  constexpr Real kTolerance = 1e-8;
  // If contacts at rest start with accurate impulses, the next steps need hardly any iterations.
  // The cost of these impulses is therefore shared by several steps.
  constexpr Real kAtRest = 0.01;  // greatest change of the first round
  constexpr std::size_t kStepsAtRest = 10;
  constexpr Real kManyRounds = 16;
  constexpr int kMaxRuns = 2;
  // A prediction from fewer rounds than this part of the cost is not reliable enough.
  constexpr std::size_t kPatience = 6;
  ContactNewtonScratch::Block& own = scratch.blocks[block];
  const auto load = [&] {
    own.rows.clear();
    for (const Index c : island) {
      own.rows.push_back(make_row(constraints[c]));
      set_excess(constraints[c], own.rows.back());
    }
  };
  const auto store_all = [&] {
    for (std::size_t n = 0; n < island.size(); ++n) store(own.rows[n], constraints[island[n]]);
  };
  load();
  bool rests = is_steady(constraints, island);
  SweepProgress progress(kTolerance);
  IslandResult result;
  int runs = 0;
  Real last = 0;
  for (std::size_t round = 1, last_round = most; round <= last_round; ++round) {
    const Real change = relax(own.rows);
    result.iterations += 2;
    result.is_solved = change <= kTolerance;
    if (result.is_solved) break;
    if (round == 1 && change > kAtRest) rests = false;
    progress.add(change);
    if (progress.has_prediction() && runs < kMaxRuns) {
      store_all();
      const std::size_t cost = own.newton.prepare(*this, constraints, island, scratch.place_of_end);
      const std::size_t rounds = progress.rounds();
      const Real left = progress.rounds_left();
      if (rounds >= cost || (kPatience * rounds >= cost && left > static_cast<Real>(cost)) ||
          (rests && kStepsAtRest * rounds >= cost && left > kManyRounds)) {
        own.excess.clear();
        for (const SweepRow& row : own.rows) own.excess.push_back(row.excess(row.slip()));
        result.iterations +=
            own.newton.run(*this, constraints, island, own.excess, scratch.place_of_end);
        load();
        ++runs;
        last_round = std::max(most, 2 * round);
        last = 0;
        progress.restart();
        continue;
      }
    }
    last = extrapolate(own.rows, last);
  }
  store_all();
  return result;
}

bool ContactSolve::sweep(std::vector<ContactConstraint>& constraints, const ContactIslands& islands,
                         ContactNewtonScratch& scratch, const SetExcess& set_excess) {
  constexpr std::size_t kIslandsPerBlock = 8;
  // The maximum number of operations is about equal for few and many contacts.
  const std::size_t most =
      std::clamp<std::size_t>(10'000 / std::max<std::size_t>(constraints.size(), 1), 50, 1000);
  std::atomic<std::size_t> greatest = 0;
  std::atomic<bool> all_solved = true;
  scratch.place_of_end.resize(model().free_count + rigid.size());
  scratch.blocks.resize((islands.count() + kIslandsPerBlock - 1) / kIslandsPerBlock);
  for_blocks<kIslandsPerBlock>(
      force_model.runner, islands.count(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t island = begin; island < end; ++island) {
          const IslandResult result = sweep_island(constraints, islands[island], most, scratch,
                                                   begin / kIslandsPerBlock, set_excess);
          raise(greatest, result.iterations);
          if (!result.is_solved) all_solved = false;
        }
      });
  if (force_model.report != nullptr) force_model.report->iterations.contacts += greatest;
  return all_solved;
}

}  // namespace vat
