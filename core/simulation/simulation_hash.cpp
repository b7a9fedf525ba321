// The hash of the data from which the next steps start.

#include "core/simulation/simulation_impl.h"
#include "core/support/hash.h"

namespace vat {
namespace {

void add_configuration(const Model& model, const Configuration& now, StateHash& hash) {
  for (Index i = 0; i < model.free_count; ++i) hash.add(now.position[i]);
  for (Index i = 0; i < model.free_count; ++i) hash.add(now.velocity[i]);
  for (const RigidState& rigid : now.rigid) {
    hash.add(rigid.center_of_mass);
    hash.add(rigid.orientation);
    hash.add(rigid.momentum);
    hash.add(rigid.angular_momentum);
  }
  for (const ContactImpulse& contact : now.contacts) {
    hash.add(std::uint64_t{contact.particle});
    hash.add(contact.other);
    hash.add(contact.drift);
    hash.add(contact.finish);
    hash.add(std::uint64_t{contact.is_steady});
  }
  for (const SpringState& spring : now.springs) {
    hash.add(spring.rest_length);
    hash.add(std::uint64_t{spring.is_torn});
  }
  for (const Real pressure : now.pressure) hash.add(pressure);
}

/// Adds the rest of the state of the stepped bodies.
void add_state(const Model& model, const State& state, StateHash& hash) {
  for (const std::uint32_t looks : state.slow_looks) hash.add(std::uint64_t{looks});
  const StepControl control = model.scene.numerics.control;
  if (control != StepControl::fixed) {
    hash.add(state.history.step);
    hash.add(std::uint64_t{state.history.held});
    hash.add(state.history.observed_rate);
  }
  hash.add(std::uint64_t{state.forces_current});
  if (!state.forces_current) return;
  if (control == StepControl::local) {
    for (const std::uint8_t level : state.levels.particle) hash.add(std::uint64_t{level});
    hash.add(std::uint64_t{state.levels.liquid});
    hash.add(state.levels.skin);
  }
  hash.add(state.bound.omega2);
  hash.add(state.bound.rate);
  for (Index i = 0; i < model.free_count; ++i) hash.add(state.forces.particle[i]);
  for (const Vec3& force : state.forces.rigid_force) hash.add(force);
  for (const Vec3& torque : state.forces.rigid_torque) hash.add(torque);
  for (const Vec3& velocity : state.forces.transport) hash.add(velocity);
}

void add_hand(const HandMotion& hand, StateHash& hash) {
  hash.add(hand.start);
  hash.add(hand.offset);
  hash.add(hand.velocity);
  hash.add(hand.target);
}

void add_controls(const Controls& controls, StateHash& hash) {
  for (const Grab& grab : controls.grabs) {
    hash.add(std::uint64_t{grab.body});
    hash.add(std::uint64_t{grab.particle});
    hash.add(grab.target);
    hash.add(grab.stiffness);
    for (const Index held : grab.held) hash.add(std::uint64_t{held});
  }
  for (const AppliedForce& applied : controls.applied_forces) {
    hash.add(std::uint64_t{applied.body});
    hash.add(applied.acceleration);
    hash.add(applied.end_step);
  }
}

}  // namespace

std::uint64_t SimulationContent::hash() const {
  StateHash hash;
  hash.add(state.step_count);
  add_configuration(all(), gather(), hash);
  if (sleepers) {
    for (const Index island : sleepers->islands) hash.add(std::uint64_t{island});
  }
  add_state(*model, state, hash);
  hash.add(all().scene.gravity);
  for (const Emitter& emitter : all().scene.emitters) {
    hash.add(std::uint64_t{emitter.open});
  }
  if (all().scene.vat && all().scene.vat->hand) add_hand(*all().scene.vat->hand, hash);
  add_controls(controls, hash);
  return hash.value();
}

std::uint64_t Simulation::state_hash() const {
  return impl_->hash();
}

}  // namespace vat
