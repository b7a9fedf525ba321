#pragma once

#include "core/saved/archive.h"
#include "core/scene/scene.h"

/// All fields of a scene for archives, in the order of core/scene/scene.h.
namespace vat {

template <class Archive>
void describe(Archive& archive, Of<Archive, IncompressibleSolve>& v) {
  auto& [density_tolerance, divergence_tolerance, most_iterations] = v;
  archive(density_tolerance, divergence_tolerance, most_iterations);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, SpringConstants>& v) {
  auto& [stiffness, damping] = v;
  archive(stiffness, damping);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, InterfaceConstants>& v) {
  auto& [stiffness, damping, friction, law, restitution, reach] = v;
  archive(stiffness, damping, friction, law, restitution, reach);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, LiquidConstants>& v) {
  auto& [stiffness, viscosity, support_radius, artificial_viscosity, surface_tension] = v;
  archive(stiffness, viscosity, support_radius, artificial_viscosity, surface_tension);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, LatticeSprings>& v) {
  auto& [structural, shear, bend] = v;
  archive(structural, shear, bend);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, Plasticity>& v) {
  auto& [yield_strain, hardening, relaxation_time, max_strain] = v;
  archive(yield_strain, hardening, relaxation_time, max_strain);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, Material>& v) {
  auto& [name, density, liquid, springs, self_contact, implicit_springs, plasticity, tearing_strain,
         elongation_limit, bulk_modulus] = v;
  archive(name, density, liquid, springs, self_contact, implicit_springs, plasticity,
          tearing_strain, elongation_limit, bulk_modulus);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, BoxShape>& v) {
  auto& [center, size] = v;
  archive(center, size);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, SphereShape>& v) {
  auto& [center, radius] = v;
  archive(center, radius);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, CylinderShape>& v) {
  auto& [center, axis, radius, height] = v;
  archive(center, axis, radius, height);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, MeshShape>& v) {
  auto& [source, vertices, triangles] = v;
  archive(source, vertices, triangles);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, ParticleShape>& v) {
  auto& [positions, velocities, masses, radii, fixed] = v;
  archive(positions, velocities, masses, radii, fixed);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, SpringDescription>& v) {
  auto& [a, b, constants, rest_length] = v;
  archive(a, b, constants, rest_length);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, PlaneWave>& v) {
  auto& [amplitude, wave_vector, phase] = v;
  archive(amplitude, wave_vector, phase);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, VectorField>& v) {
  auto& [center, gradient, waves] = v;
  archive(center, gradient, waves);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, Melting>& v) {
  auto& [into, at] = v;
  archive(into, at);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, BodyDescription>& v) {
  auto& [name, kind, material, shape, spacing, mass, radius, position, orientation, velocity,
         angular_velocity, springs, velocity_field, displacement_field, jitter, seed, release,
         fixed, melting] = v;
  archive(name, kind, material, shape, spacing, mass, radius);
  archive(position, orientation, velocity, angular_velocity);
  archive(springs, velocity_field, displacement_field, jitter, seed);
  archive(release, fixed, melting);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, InterfaceDescription>& v) {
  auto& [materials, constants, threshold, contact_angle] = v;
  archive(materials, constants, threshold, contact_angle);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, SlideMotion>& v) {
  auto& [axis, stroke, period] = v;
  archive(axis, stroke, period);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, Wall>& v) {
  auto& [no_slip, velocity] = v;
  archive(no_slip, velocity);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, Vat>& v) {
  auto& [min, max, lid, motion, walls, hand] = v;  // a hand's motion is none of a scene's
  archive(min, max, lid, motion, walls);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, HandMotion>& v) {
  auto& [start, offset, velocity, target] = v;
  archive(start, offset, velocity, target);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, Periodicity>& v) {
  auto& [min, max, axes] = v;
  archive(min, max, axes);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, CentralField>& v) {
  auto& [center, angular_frequency] = v;
  archive(center, angular_frequency);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, Settling>& v) {
  auto& [drag, until] = v;
  archive(drag, until);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, Sleeping>& v) {
  auto& [speed, after] = v;
  archive(speed, after);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, Emitter>& v) {
  auto& [name, body, position, direction, radius, size, speed, from, until, most_particles, open] =
      v;
  archive(name, body, position, direction, radius, size);
  archive(speed, from, until, most_particles, open);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, Drain>& v) {
  auto& [name, min, max] = v;
  archive(name, min, max);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, ForceSwitches>& v) {
  auto& [gravity, pressure, viscosity, springs, contacts, walls] = v;
  archive(gravity, pressure, viscosity, springs, contacts, walls);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, Numerics>& v) {
  auto& [integrator, step, tick, control, tolerance, accuracy] = v;
  archive(integrator, step, tick, control, tolerance, accuracy);
}
template <class Archive>
void describe(Archive& archive, Of<Archive, Scene>& v) {
  auto& [name, title, description, gravity, materials, interfaces, default_interface, bodies, vat,
         periodic, central_field, settling, sleeping, emitters, drains, forces, pressure_solver,
         incompressible, printed_pressure_force, kernel, pair_precision, surface_model, dimensions,
         numerics] = v;
  archive(name, title, description, gravity, materials, interfaces);
  archive(default_interface, bodies, vat, periodic, central_field, settling);
  archive(sleeping, emitters, drains, forces, pressure_solver, incompressible);
  archive(printed_pressure_force, kernel, pair_precision, surface_model, dimensions);
  archive(numerics);
}

}  // namespace vat
