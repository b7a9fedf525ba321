#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"

namespace vat {

/// Sums over one body, fixed particles included. In two dimensions, masses, momenta, forces and
/// energies are per metre of depth.
struct BodyDiagnostics {
  BodyId id;
  std::string name;
  Real mass;              ///< [kg]
  Vec3 center_of_mass;    ///< [m]
  Vec3 linear_momentum;   ///< [kg m/s]
  Vec3 angular_momentum;  ///< about the origin of the world [kg m^2/s]
  Vec3 outer_force;   ///< of walls and other bodies, without gravity, central field and users [N]
  Vec3 outer_torque;  ///< of these forces about the centre of mass, and of viscosity [N m]
  std::optional<Quat> orientation;       ///< rigid bodies
  std::optional<Vec3> angular_velocity;  ///< rigid bodies, world axes [rad/s]
};

/// Cost and result of one solve of an incompressible liquid.
struct SolveReport {
  int iterations = 0;  ///< products with the matrix
  Real mean = 0;      ///< mean over liquid particles of the relative density change above the limit
  Real greatest = 0;  ///< maximum of the same change
};

/// Reports of the solves of the last step; see core/liquid/incompressible/volume_solve.h.
struct VolumeReport {
  SolveReport velocities;  ///< changes of density in one step
  SolveReport places;      ///< densities above the rest density
};

/// Measurements of the present state. They do not influence it.
struct Diagnostics {
  Real time;  ///< [s]
  std::vector<BodyDiagnostics> bodies;
  Real kinetic_energy;        ///< of all particles and rigid bodies [J]
  Real gravitational_energy;  ///< -m g.x of all particles, and m Omega^2 |x - center|^2 / 2 of the
                              ///< central field; 0 without gravity [J]
  Real elastic_energy;        ///< of static springs, and of cells with a bulk modulus [J]
  Real contact_energy;        ///< of dynamic connections and walls [J]
  Real mean_density_error;    ///< of liquids: mean of max(0, rho/rho_0 - 1); 0 without liquid
  Real max_density_error;     ///< of liquids: maximum of rho/rho_0 - 1, at least 0
  std::optional<VolumeReport> volume;  ///< of incompressible liquids
  std::size_t torn_springs;            ///< static springs that exert no force any more
  std::size_t particles_outside;       ///< beyond a wall of the vat
  std::size_t sleeping_bodies;         ///< see Scene::sleeping
  std::uint64_t emitted_particles;     ///< since time 0
  std::uint64_t drained_particles;     ///< since time 0
};

}  // namespace vat
