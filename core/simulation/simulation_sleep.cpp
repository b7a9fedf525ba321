// Sleeping bodies of a simulation; see core/sleep/islands.h.

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/simulation/simulation_impl.h"
#include "core/sleep/drives.h"
#include "core/sleep/islands.h"
#include "core/state/body_state.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Number of checks between two searches for islands, each of which costs about as much as a search
/// for contacts.
constexpr std::uint64_t kLooksPerSearch = 8;

/// The number of checks that a body must rest before it may sleep.
std::uint32_t looks_of_rest(const Scene& scene) {
  constexpr Real kRounding = 1e-9;
  const Real looks = 1 + std::ceil(scene.sleeping->after / scene.numerics.tick - kRounding);
  return static_cast<std::uint32_t>(std::min(looks, Real{std::numeric_limits<int>::max()}));
}

/// The numbers of slow checks for the bodies of a new model; those of bodies that were stepped
/// before continue.
std::vector<std::uint32_t> carried_looks(const Model& before, const std::vector<std::uint32_t>& of,
                                         const Model& model) {
  std::vector<std::uint32_t> looks(model.bodies.size(), 0);
  std::size_t b = 0;
  for (std::size_t n = 0; n < looks.size(); ++n) {  // both are in the order of the scene
    while (b < of.size() && before.bodies[b].id < model.bodies[n].id) ++b;
    if (b < of.size() && before.bodies[b].id == model.bodies[n].id) looks[n] = of[b];
  }
  return looks;
}

bool has_all_of(const Model& before, const Model& model) {
  return std::ranges::includes(before.bodies, model.bodies, {}, &ModelBody::id, &ModelBody::id);
}

}  // namespace

GuardBounds SimulationImpl::bounds_of(const SimulationContent& content) {
  VAT_CHECK(content.model != nullptr);
  GuardBounds bounds = guard_bounds(*content.model);
  if (!content.sleepers) return bounds;
  const std::vector<Real> travel = guard_bounds(*content.sleepers->model).travel;
  const std::vector<Index>& islands = content.sleepers->islands;
  std::size_t n = 0;
  for (std::size_t b = 0; b < islands.size(); ++b) {
    if (islands[b] == kAwake) bounds.travel[n++] = travel[b];
  }
  return bounds;
}

Configuration SimulationContent::gather() const {
  if (!sleepers) return state.now;
  Configuration result = sleepers->configuration;
  write_part(*model, state.now, *sleepers->model, result);
  add_contacts_of_part(*model, state.now, *sleepers->model, result);
  return result;
}

void SimulationImpl::show() {
  if (!sleepers) {
    shown_sleepers.reset();
    return;
  }
  if (shown_sleepers != sleepers) shown = sleepers->configuration;
  shown_sleepers = sleepers;
  write_part(*model, state.now, *sleepers->model, shown);
}

void SimulationImpl::step_others_than(std::vector<Index> islands,
                                      std::shared_ptr<const Model> whole, Configuration now) {
  VAT_CHECK(whole != nullptr && islands.size() == whole->bodies.size());
  settle_still_bodies(*whole, now, islands);
  const bool none_sleeps =
      std::ranges::all_of(islands, [](Index island) { return island == kAwake; });
  SimulationContent next{none_sleeps ? whole : compile_awake(*whole, islands), state, {}, nullptr};
  next.state.now = part_of(*whole, now, *next.model);
  next.state.slow_looks = carried_looks(*model, state.slow_looks, *next.model);
  // Forces on bodies near sleepers do not include those of the sleepers.
  const bool keeps_forces = state.forces_current && has_all_of(*model, *next.model) &&
                            model->scene.numerics.control != StepControl::local;
  next.state.forces =
      keeps_forces ? forces_of_part(*model, state.forces, *next.model) : no_forces(*next.model);
  next.state.forces_current = keeps_forces;
  next.controls = rebind(controls, *model, *next.model);
  if (!none_sleeps) {
    next.sleepers =
        std::make_shared<const Sleepers>(std::move(whole), std::move(now), std::move(islands));
  }
  GuardBounds new_bounds = bounds_of(next);
  StepBounds new_step_bounds = find_step_bounds(*next.model);
  adopt(std::move(next), std::move(new_bounds), std::move(new_step_bounds));
}

void SimulationImpl::wake_all() {
  if (sleepers) {
    const std::size_t bodies = sleepers->islands.size();
    step_others_than(std::vector<Index>(bodies, kAwake), sleepers->model, gather());
  }
  std::ranges::fill(state.slow_looks, 0);
}

bool SimulationImpl::count_slow_looks(const Configuration& at,
                                      std::span<const ParticleMotion> particles,
                                      std::vector<std::uint32_t>& counts) const {
  const Scene& scene = model->scene;
  if (prevents_sleep(scene, time())) {
    std::ranges::fill(counts, 0);
    return false;
  }
  const std::uint32_t needed = looks_of_rest(scene);
  const Real speed = scene.sleeping->speed;
  VAT_CHECK(counts.size() == model->bodies.size());
  bool any_rested = false;
  for (Index b = 0; b < model->bodies.size(); ++b) {
    const ModelBody& body = model->bodies[b];
    const bool is_measured = !particles.empty() && body.kind != BodyKind::rigid;
    const Real greatest =
        is_measured ? particles[b].speed : greatest_speed(*model, body, at, speed);
    const bool is_slow =
        greatest <= speed && !is_still(*model, body, at) && !is_driven(*model, state, controls, b);
    counts[b] = is_slow ? std::min(counts[b] + 1, needed) : 0;
    any_rested = any_rested || counts[b] == needed;
  }
  return any_rested && state.step_count / steps_per_tick() % kLooksPerSearch == 0;
}

void SimulationImpl::look_for_rest() {
  if (!count_slow_looks(state.now, {}, state.slow_looks)) return;
  const std::uint32_t needed = looks_of_rest(model->scene);
  pose_rigid_particles();
  std::vector<char> rested;
  for (const std::uint32_t looks : state.slow_looks) rested.push_back(looks == needed);
  std::vector<Index> islands = find_resting_islands(*model, state.now, rested);
  if (std::ranges::all_of(islands, [](Index island) { return island == kAwake; })) return;
  Configuration now = gather();
  // The islands in the model of all bodies.
  std::vector<Index> all_islands = sleepers ? sleepers->islands : islands;
  if (sleepers) {
    std::vector<Index> awake;
    for (Index b = 0; b < all_islands.size(); ++b) {
      if (all_islands[b] == kAwake) awake.push_back(b);
    }
    VAT_CHECK(awake.size() == islands.size());
    for (std::size_t n = 0; n < islands.size(); ++n) {
      if (islands[n] != kAwake) all_islands[awake[n]] = awake[islands[n]];
    }
  }
  stop(all(), all_islands, now);
  step_others_than(std::move(all_islands), sleepers ? sleepers->model : model, std::move(now));
}

void SimulationImpl::wake_near() {
  VAT_CHECK(sleepers != nullptr);
  const Model& whole = *sleepers->model;
  const Real reach = greatest_reach(whole);
  if (reach == 0) return;
  pose_rigid_particles();
  woken.clear();
  const auto is_woken = [&](Index body) {
    return std::ranges::find(woken, sleepers->islands[body]) != woken.end();
  };
  for (const ModelBody& body : model->bodies) {
    if (is_still(*model, body, state.now)) continue;
    const auto particles =
        std::span(state.now.position).subspan(body.particles.begin, body.particles.size());
    const Real speed =
        greatest_speed(*model, body, state.now, std::numeric_limits<Real>::infinity());
    const Real distance = waking_distance(reach, speed, step_size());
    sleepers->resting.find_candidates(particles, distance, near);
    std::erase_if(near, is_woken);
    sleepers->resting.keep_near(particles, distance, near);
    for (const Index other : near) {
      if (!is_woken(other)) woken.push_back(sleepers->islands[other]);
    }
  }
  if (woken.empty()) return;
  std::vector<Index> islands = sleepers->islands;
  for (const Index island : woken) std::ranges::replace(islands, island, kAwake);
  step_others_than(std::move(islands), sleepers->model, gather());
}

void SimulationImpl::sleep_and_wake() {
  enter("sleep");
  if (state.step_count % steps_per_tick() == 0) look_for_rest();
  if (sleepers && !model->bodies.empty()) wake_near();
}

}  // namespace vat
