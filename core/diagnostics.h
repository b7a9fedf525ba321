#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"

namespace vat {

/// Sums over one body. Particles that are fixed count with the mass they have. In two dimensions
/// masses, momenta, forces and energies are per metre of depth.
struct BodyDiagnostics {
  BodyId id;
  std::string name;
  Real mass;              ///< [kg]
  Vec3 center_of_mass;    ///< [m]
  Vec3 linear_momentum;   ///< [kg m/s]
  Vec3 angular_momentum;  ///< about the world's origin [kg m^2/s]
  Vec3 outer_force;   ///< by walls and other bodies: not by gravity, the central field, users [N]
  Vec3 outer_torque;  ///< of the same forces about the centre of mass, and of viscosity [N m]
  std::optional<Quat> orientation;       ///< rigid bodies
  std::optional<Vec3> angular_velocity;  ///< rigid bodies, world axes [rad/s]
};

/// What one solve of an incompressible liquid took, and what it left.
struct SolveReport {
  int iterations = 0;  ///< products with the matrix
  Real mean = 0;       ///< over liquid particles, of |relative change of density| that is too much
  Real greatest = 0;   ///< the same
};

/// Results of the last step's solves; see core/liquid/incompressible/volume_solve.h.
struct VolumeReport {
  SolveReport velocities;  ///< changes of density in one step
  SolveReport places;      ///< densities above the one at rest
};

/// Measured over the present state; nothing here feeds back into it.
struct Diagnostics {
  Real time;  ///< [s]
  std::vector<BodyDiagnostics> bodies;
  Real kinetic_energy;        ///< [J] of all particles and rigid bodies
  Real gravitational_energy;  ///< [J] -m g.x over all particles, and m Omega^2 |x - center|^2 / 2
                              ///< of the central field; 0 where gravity is off
  Real elastic_energy;        ///< [J] in static springs, and in cells that keep their volume
  Real contact_energy;        ///< [J] in dynamic connections and against the walls
  Real mean_density_error;    ///< liquid: mean of max(0, rho/rho_0 - 1); 0 without liquid
  Real max_density_error;     ///< liquid: greatest rho/rho_0 - 1, at least 0
  std::optional<VolumeReport> volume;  ///< of incompressible liquids
  std::size_t torn_springs;            ///< of static ones, which have no force any more
  std::size_t particles_outside;       ///< beyond a wall of the vat
  std::size_t sleeping_bodies;         ///< see Scene::sleeping
  std::uint64_t emitted_particles;  ///< since time 0: what there was at the start, and this, less
  std::uint64_t drained_particles;  ///< this, is what there is, but for commands
};

}  // namespace vat
