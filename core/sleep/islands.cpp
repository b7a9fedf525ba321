#include "core/sleep/islands.h"

#include <algorithm>
#include <limits>

#include "core/sleep/resting_bodies.h"
#include "core/state/rigid_motion.h"
#include "core/support/check.h"
#include "core/support/disjoint_sets.h"

namespace vat {

Real greatest_reach(const Model& model) {
  Real reach = model.contact_reach;
  for (const ModelBody& body : model.bodies) {
    if (body.kind != BodyKind::liquid) continue;
    reach = std::max(reach, model.liquids[body.material]->support_radius);
  }
  return reach;
}

Real waking_distance(Real reach, Real speed, Real step) {
  return reach + std::max(reach, 2 * speed * step);
}

Real island_distance(Real reach, Real speed, Real step) {
  return waking_distance(reach, speed, step) + reach / 2;
}

Real greatest_speed(const Model& model, const ModelBody& body, const Configuration& at,
                    Real limit) {
  if (body.kind == BodyKind::rigid) {
    VAT_CHECK(body.rigid < at.rigid.size());
    const RigidModel& rigid = model.rigid_bodies[body.rigid];
    const RigidState& state = at.rigid[body.rigid];
    Real extent2 = 0;
    for (Index i = body.particles.begin; i < body.particles.end; ++i) {
      extent2 = std::max(extent2, model.local_position[i - model.free_count].squaredNorm());
    }
    const Vec3 omega = angular_velocity(rigid, state.orientation, state.angular_momentum);
    return rigid.inverse_mass * state.momentum.norm() + omega.norm() * std::sqrt(extent2);
  }
  VAT_CHECK(body.particles.end <= at.velocity.size());
  Real greatest2 = 0;
  for (Index i = body.particles.begin; i < body.particles.end; ++i) {
    greatest2 = std::max(greatest2, at.velocity[i].squaredNorm());
    if (greatest2 > limit * limit) break;
  }
  return std::sqrt(greatest2);
}

bool is_still(const Model& model, const ModelBody& body, const Configuration& at) {
  if (body.particles.size() == 0) return true;
  if (body.kind != BodyKind::rigid) return false;
  const RigidState& state = at.rigid[body.rigid];
  return model.rigid_bodies[body.rigid].free_from == kNever && state.momentum.isZero(0) &&
         state.angular_momentum.isZero(0);
}

namespace {

struct IslandSearch {
  const Model& model;
  const Configuration& at;
  const std::vector<char>& rested;
  Real reach;
  RestingBodies resting;
  std::vector<Index> near;  ///< scratch

  std::span<const Vec3> particles(Index b) const {
    const IndexRange& range = model.bodies[b].particles;
    return std::span(at.position).subspan(range.begin, range.size());
  }
};

/// Small bodies search for large ones, which costs less than the reverse.
void join_islands(IslandSearch& search, std::vector<Index> bodies, DisjointSets& sets) {
  std::ranges::stable_sort(bodies, {},
                           [&](Index b) { return search.model.bodies[b].particles.size(); });
  const Real distance = island_distance(search.reach, 0, 0);
  for (const Index b : bodies) {
    search.resting.find_candidates(search.particles(b), distance, search.near);
    std::erase_if(search.near, [&](Index other) { return sets.root(other) == sets.root(b); });
    search.resting.keep_near(search.particles(b), distance, search.near);
    for (const Index other : search.near) sets.join(b, other);
  }
}

/// For each set of resting bodies, whether another body is near.
std::vector<char> find_disturbed(IslandSearch& search, DisjointSets& sets) {
  const Model& model = search.model;
  std::vector<char> disturbed(model.bodies.size(), 0);
  for (Index b = 0; b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    if (search.rested[b] || is_still(model, body, search.at)) continue;
    const Real speed =
        greatest_speed(model, body, search.at, std::numeric_limits<Real>::infinity());
    const Real distance = island_distance(search.reach, speed, model.scene.numerics.step);
    search.resting.find_candidates(search.particles(b), distance, search.near);
    std::erase_if(search.near, [&](Index other) { return disturbed[sets.root(other)] != 0; });
    search.resting.keep_near(search.particles(b), distance, search.near);
    for (const Index other : search.near) disturbed[sets.root(other)] = 1;
  }
  return disturbed;
}

}  // namespace

std::vector<Index> find_resting_islands(const Model& model, const Configuration& at,
                                        const std::vector<char>& rested) {
  VAT_CHECK(rested.size() == model.bodies.size());
  std::vector<Index> bodies;
  for (Index b = 0; b < rested.size(); ++b) {
    if (rested[b]) bodies.push_back(b);
  }
  std::vector<Index> islands(model.bodies.size(), kAwake);
  DisjointSets sets;
  sets.reset(model.bodies.size());
  std::vector<char> disturbed(model.bodies.size(), 0);
  if (const Real reach = greatest_reach(model); reach > 0) {
    IslandSearch search{model, at, rested, reach, {}, {}};
    search.resting.build(model, at.position, bodies, island_distance(reach, 0, 0));
    join_islands(search, bodies, sets);
    disturbed = find_disturbed(search, sets);
  }
  for (const Index b : bodies) {
    if (!disturbed[sets.root(b)]) islands[b] = sets.root(b);
  }
  return islands;
}

}  // namespace vat
