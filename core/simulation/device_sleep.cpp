// Sleep of bodies whose steps an engine takes. The engine reads only the motion of bodies, as long
// as the same bodies sleep; see core/sleep/islands.h for the rules.

#include <algorithm>
#include <limits>
#include <utility>

#include "core/simulation/simulation_impl.h"
#include "core/sleep/islands.h"
#include "core/state/rigid_motion.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Displacement in a step / GuardBounds::travel, at most. The guard checks the speeds at the ends
/// of a step, between which a body can be faster.
constexpr Real kTravels = 2;

}  // namespace

std::uint32_t SimulationImpl::steps_until_tick(std::uint32_t most) const {
  const std::uint64_t since_tick = state.step_count % steps_per_tick();
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(most, steps_per_tick() - since_tick));
}

std::uint32_t SimulationImpl::steps_without_wake_by(Index b, Real reach, std::uint32_t most) {
  const ModelBody& body = model->bodies[b];
  const bool is_rigid = body.kind == BodyKind::rigid;
  Real speed = motions.particles[b].speed;
  Vec3 ends[2] = {motions.particles[b].low, motions.particles[b].high};
  if (is_rigid) {
    speed = greatest_speed(*model, body, seen, std::numeric_limits<Real>::infinity());
    const Vec3 center = seen.rigid[body.rigid].center_of_mass;
    ends[0] = center.array() - bounds.extent[body.rigid];
    ends[1] = center.array() + bounds.extent[body.rigid];
  }
  const Real travel = kTravels * std::max(bounds.travel[b], speed * step_size());
  for (std::uint32_t steps = most; steps > 1; steps /= 2) {
    const Real distance = waking_distance(reach, travel / step_size(), step_size());
    sleepers->resting.find_candidates(ends, static_cast<Real>(steps) * travel + distance, near);
    if (near.empty()) return steps;
  }
  const Real distance = waking_distance(reach, speed, step_size());
  sleepers->resting.find_candidates(ends, distance, near);
  if (near.empty()) return 1;
  if (!is_rigid) return 0;
  seen.position.resize(model->particle_count);
  seen.velocity.resize(model->particle_count);
  pose_rigid_body(*model, model->rigid_bodies[body.rigid], seen.rigid[body.rigid], seen);
  const auto particles =
      std::span(seen.position).subspan(body.particles.begin, body.particles.size());
  sleepers->resting.keep_near(particles, distance, near);
  return near.empty() ? 1 : 0;
}

std::uint32_t SimulationImpl::steps_without_wake(std::uint32_t most) {
  const Real reach = greatest_reach(*sleepers->model);
  if (reach == 0) return most;
  for (Index b = 0; b < model->bodies.size() && most > 0; ++b) {
    if (is_still(*model, model->bodies[b], seen)) continue;
    most = steps_without_wake_by(b, reach, most);
  }
  return most;
}

std::uint32_t SimulationImpl::find_quiet_steps(std::uint32_t most) {
  const bool is_tick = state.step_count % steps_per_tick() == 0;
  if (!is_tick && !sleepers) return most;
  if (!engine->read_motions(motions)) return 0;
  VAT_CHECK(motions.rigid.size() == model->rigid_bodies.size() &&
            motions.particles.size() == model->bodies.size());
  seen.rigid.swap(motions.rigid);
  next_looks = state.slow_looks;
  if (is_tick && count_slow_looks(seen, motions.particles, next_looks)) return 0;
  const std::uint32_t quiet = sleepers ? steps_without_wake(most) : most;
  if (quiet > 0) std::swap(state.slow_looks, next_looks);
  return quiet;
}

std::uint32_t SimulationImpl::sleep_and_wake_before(std::uint32_t most) {
  enter("sleep");
  most = steps_until_tick(most);
  if (engine != nullptr && device_is_current && engine_fits && engine_model == model) {
    if (const std::uint32_t quiet = find_quiet_steps(most); quiet > 0) return quiet;
    read_from_device();
  }
  sleep_and_wake();
  return sleepers ? 1 : most;
}

bool SimulationImpl::advance_quietly_on_device(std::uint32_t steps, AdvanceReport& report) {
  if (!device_is_current || !engine_fits || engine_model != model) return false;
  if (steps_until_tick(steps) < steps) return false;
  enter("sleep");
  const std::vector<std::uint32_t> before = state.slow_looks;
  if (find_quiet_steps(steps) == steps && advance_on_device(steps, report)) return true;
  state.slow_looks = before;
  return false;
}

}  // namespace vat
