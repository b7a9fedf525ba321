#pragma once

#include "core/sampling/sampling.h"
#include "core/saved/archive.h"
#include "core/state/state.h"

/// Definitions of describe() for structs that are saved in part.
namespace vat {

/// Describes the fields of a vat except `hand`, which is not part of a scene.
template <class Archive>
void describe(Archive& archive, Of<Archive, Vat>& v) {
  auto& [min, max, lid, motion, walls, hand] = v;
  archive(min, max, lid, motion, walls);
}
/// Describes the fields of the numerics except `device`. The caller of Simulation::load() sets the
/// device of the steps.
template <class Archive>
void describe(Archive& archive, Of<Archive, Numerics>& v) {
  auto& [integrator, step, tick, control, tolerance, accuracy, device] = v;
  archive(integrator, step, tick, control, tolerance, accuracy);
}
/// Describes the fields of a body except `motion`, `axle` and `sub_steps`, which follow the state;
/// see Snapshot::to_bytes().
template <class Archive>
void describe(Archive& archive, Of<Archive, BodyDescription>& v) {
  auto& [name, kind, material, shape, spacing, mass, radius, position, orientation, velocity,
         angular_velocity, springs, velocity_field, displacement_field, jitter, seed, release,
         fixed, melting, motion, axle, sub_steps] = v;
  archive(name, kind, material, shape, spacing, mass, radius, position, orientation, velocity,
          angular_velocity, springs, velocity_field, displacement_field, jitter, seed, release,
          fixed, melting);
}
/// Describes the fields of a material except `appearance`, which follows the state; see
/// Snapshot::to_bytes().
template <class Archive>
void describe(Archive& archive, Of<Archive, Material>& v) {
  auto& [name, density, liquid, springs, self_contact, implicit_springs, plasticity, tearing_strain,
         elongation_limit, bulk_modulus, appearance] = v;
  archive(name, density, liquid, springs, self_contact, implicit_springs, plasticity,
          tearing_strain, elongation_limit, bulk_modulus);
}
/// Describes the fields of a liquid sample. Liquids have no springs, cells and fixed particles.
template <class Archive>
void describe(Archive& archive, Of<Archive, SampledBody>& v) {
  auto& [positions, velocities, masses, radii, fixed, springs, cells, in_nozzles, numbers,
         next_number] = v;
  archive(positions, velocities, masses, radii, in_nozzles, numbers, next_number);
}
/// Describes the fields of the forces except `friction_torque`, which is used only during an
/// evaluation.
template <class Archive>
void describe(Archive& archive, Of<Archive, Forces>& v) {
  auto& [particle, rigid_force, rigid_torque, friction_torque, transport] = v;
  archive(particle, rigid_force, rigid_torque, transport);
}
/// Describes the state. Forces and their levels are omitted if they are not current, because they
/// are then never read.
template <class Archive>
void describe(Archive& archive, Of<Archive, State>& v) {
  auto& [now, step_count, forces, bound, forces_current, history, volume, levels, emitted, drained,
         slow_looks] = v;
  archive(now, step_count, bound, history, volume, emitted, drained, slow_looks, forces_current);
  if (forces_current) archive(forces, levels);
}

}  // namespace vat
