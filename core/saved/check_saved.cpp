#include "core/saved/check_saved.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/laws/vat_motion.h"
#include "core/limits.h"
#include "core/scene/lookup.h"
#include "core/sleep/islands.h"
#include "core/validation/validate.h"

namespace vat {
namespace {

Error bad_value(std::string path, std::string message) {
  return {"bad_value", std::move(path), std::move(message)};
}

bool are_finite(const std::vector<Vec3>& values) {
  return std::ranges::all_of(values, [](const Vec3& value) { return value.allFinite(); });
}

bool are_positive(const std::vector<Real>& values) {
  return std::ranges::all_of(values, [](Real v) { return v > 0 && std::isfinite(v); });
}

/// Returns whether the values are ascending and below `end`.
bool rise_below(const std::vector<Index>& values, std::size_t end) {
  return std::ranges::adjacent_find(values, std::greater_equal()) == values.end() &&
         (values.empty() || values.back() < end);
}

bool is_sample(const SampledBody& sample) {
  const std::size_t count = sample.positions.size();
  std::vector<Index> in_nozzles;
  for (const NozzleParticle& each : sample.in_nozzles) in_nozzles.push_back(each.particle);
  return sample.velocities.size() == count && sample.masses.size() == count &&
         sample.radii.size() == count && are_finite(sample.positions) &&
         are_finite(sample.velocities) && are_positive(sample.masses) &&
         are_positive(sample.radii) && rise_below(in_nozzles, count) &&
         (sample.numbers.empty() || sample.numbers.size() == count) &&
         rise_below(sample.numbers, sample.next_number);
}

/// Returns whether columns and contacts fit the model.
bool fits(const Model& model, const Configuration& at) {
  const auto is_contact = [&](const ContactImpulse& contact) {
    return contact.particle < model.particle_count &&
           contact.other < std::uint64_t{kWallCount} + model.particle_count;
  };
  return at.position.size() == model.particle_count && at.velocity.size() == model.particle_count &&
         at.rigid.size() == model.rigid_bodies.size() &&
         at.springs.size() == (model.springs_change ? model.spring_ends.size() : 0) &&
         at.pressure.size() == (model.is_incompressible ? model.liquid_count : 0) &&
         are_finite(at.position) && are_finite(at.velocity) &&
         std::ranges::all_of(at.contacts, is_contact);
}

bool fits(const Model& model, const Forces& forces) {
  return forces.particle.size() == model.particle_count &&
         forces.rigid_force.size() == model.rigid_bodies.size() &&
         forces.rigid_torque.size() == model.rigid_bodies.size() &&
         (forces.transport.empty() || forces.transport.size() == model.liquid_count);
}

bool fits(const Model& model, const LocalLevels& levels) {
  constexpr auto kMost = static_cast<std::uint8_t>(kMaxStepLevel);
  const bool is_local = model.scene.numerics.control == StepControl::local;
  return (!is_local || levels.particle.size() == model.particle_count) && levels.liquid <= kMost &&
         std::ranges::all_of(levels.particle, [](std::uint8_t level) { return level <= kMost; });
}

/// Returns whether the index and the id belong to one body of the model.
bool is_of(const Model& model, Index body, BodyId id) {
  return body < model.bodies.size() && model.bodies[body].id == id;
}

bool fits(const Model& model, const Grab& grab) {
  if (!is_of(model, grab.body, grab.body_id)) return false;
  const Index count = model.bodies[grab.body].particles.size();
  return grab.particle < count && !grab.held.empty() && rise_below(grab.held, count) &&
         grab.target.allFinite();
}

}  // namespace

Status check_saved_scene(const Scene& scene, const std::vector<SavedBody>& bodies, BodyId next_id) {
  if (bodies.size() != scene.bodies.size()) {
    return bad_value("/bodies", "there must be one for each body of the scene");
  }
  BodyId last = 0;
  std::vector<const SampledBody*> samples;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const std::string path = body_path(b);
    if (bodies[b].id <= last || bodies[b].id >= next_id) {
      return bad_value(path + "/id", "must exceed the preceding ids and be below the next one");
    }
    last = bodies[b].id;
    samples.push_back(bodies[b].sample ? &*bodies[b].sample : nullptr);
    if (bodies[b].sample && !is_sample(*bodies[b].sample)) {
      return bad_value(path + "/sample", "must be particles of a liquid");
    }
  }
  Errors errors = find_changed_errors(scene, samples);
  if (errors.empty()) return {};
  return bad_value("/scene" + errors[0].path, errors[0].message);
}

Status check_saved_sleepers(const Model& model, const Configuration& at,
                            const std::vector<Index>& islands) {
  if (!fits(model, at)) return bad_value("/sleepers", "must have the columns of its bodies");
  const auto is_named = [&](Index island) {
    return island == kAwake || (island < islands.size() && islands[island] == island);
  };
  const auto sleeps = [](Index island) { return island != kAwake; };
  if (islands.size() != model.bodies.size() || !std::ranges::all_of(islands, is_named) ||
      !std::ranges::any_of(islands, sleeps)) {
    return bad_value("/sleepers/islands", "must be identified by one of their bodies");
  }
  return {};
}

Status check_saved_state(const Model& model, const State& state) {
  if (!fits(model, state.now) || !fits(model, state.forces) ||
      (state.forces_current && !fits(model, state.levels)) ||
      state.slow_looks.size() != (model.scene.sleeping ? model.bodies.size() : 0)) {
    return bad_value("/state", "must have the columns of its bodies");
  }
  return {};
}

Status check_saved_hand(const HandMotion& hand) {
  const auto is_within = [](const Vec3& value, Real most) {
    return value.allFinite() && value.cwiseAbs().maxCoeff() <= most;
  };
  constexpr Real kRoundingFactor = 1 + 1e-9;
  if (std::isfinite(hand.start) && is_within(hand.offset, 2 * kMaxLength) &&
      is_within(hand.velocity, kRoundingFactor * kMaxHandSpeed) &&
      is_within(hand.target, kMaxLength)) {
    return {};
  }
  return bad_value("/hand", "must be a possible motion of the vat");
}

Status check_saved_controls(const Model& model, const Controls& controls) {
  const auto is_grab = [&](const Grab& grab) { return fits(model, grab); };
  const auto is_applied = [&](const AppliedForce& applied) {
    return is_of(model, applied.body, applied.body_id) && applied.acceleration.allFinite();
  };
  if (controls.grabs.size() > kMaxGrabs || !std::ranges::all_of(controls.grabs, is_grab)) {
    return bad_value("/grabs", "must be of existing particles");
  }
  if (controls.applied_forces.size() > kMaxAppliedForces ||
      !std::ranges::all_of(controls.applied_forces, is_applied)) {
    return bad_value("/forces", "must be of existing bodies");
  }
  return {};
}

}  // namespace vat
