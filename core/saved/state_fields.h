#pragma once

#include "core/numerics/stable_step.h"
#include "core/sampling/sampling.h"
#include "core/saved/archive.h"
#include "core/state/controls.h"
#include "core/state/state.h"

/// The fields of a state and of controls, for archives.
namespace vat {

template <class Archive>
void describe(Archive& archive, Of<Archive, Oscillation>& v) {
  auto& [omega2, rate] = v;
  archive(omega2, rate);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, NozzleParticle>& v) {
  auto& [particle, free_from] = v;
  archive(particle, free_from);
}
/// Fields of a liquid, which has no springs, cells and fixed particles.
template <class Archive>
void describe(Archive& archive, Of<Archive, SampledBody>& v) {
  auto& [positions, velocities, masses, radii, fixed, springs, cells, in_nozzles, numbers,
         next_number] = v;
  archive(positions, velocities, masses, radii, in_nozzles, numbers, next_number);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, RigidState>& v) {
  auto& [center_of_mass, orientation, momentum, angular_momentum] = v;
  archive(center_of_mass, orientation, momentum, angular_momentum);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, ContactImpulse>& v) {
  auto& [particle, other, drift, finish, is_steady] = v;
  archive(particle, other, drift, finish, is_steady);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, SpringState>& v) {
  auto& [rest_length, is_torn] = v;
  archive(rest_length, is_torn);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, Configuration>& v) {
  auto& [position, velocity, rigid, contacts, springs, pressure] = v;
  archive(position, velocity, rigid, contacts, springs, pressure);
}
/// Without `friction_torque`, which is read only during an evaluation.
template <class Archive>
void describe(Archive& archive, Of<Archive, Forces>& v) {
  auto& [particle, rigid_force, rigid_torque, friction_torque, transport] = v;
  archive(particle, rigid_force, rigid_torque, transport);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, StepHistory>& v) {
  auto& [step, held, observed_rate] = v;
  archive(step, held, observed_rate);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, LocalLevels>& v) {
  auto& [particle, liquid, skin] = v;
  archive(particle, liquid, skin);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, SolveReport>& v) {
  auto& [iterations, mean, greatest] = v;
  archive(iterations, mean, greatest);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, VolumeReport>& v) {
  auto& [velocities, places] = v;
  archive(velocities, places);
}
/// Forces that are not current, and their levels, are never read.
template <class Archive>
void describe(Archive& archive, Of<Archive, State>& v) {
  auto& [now, step_count, forces, bound, forces_current, history, volume, levels, emitted, drained,
         slow_looks] = v;
  archive(now, step_count, bound, history, volume, emitted, drained, slow_looks, forces_current);
  if (forces_current) archive(forces, levels);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, Grab>& v) {
  auto& [id, body_id, body, particle, held, target, stiffness, damping, max_force, held_mass] = v;
  archive(id, body_id, body, particle, held, target);
  archive(stiffness, damping, max_force, held_mass);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, AppliedForce>& v) {
  auto& [body_id, body, acceleration, end_step] = v;
  archive(body_id, body, acceleration, end_step);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, Controls>& v) {
  auto& [grabs, applied_forces] = v;
  archive(grabs, applied_forces);
}

}  // namespace vat
