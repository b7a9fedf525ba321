#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"

namespace vat {

/// Sums over the particles of one body, including fixed particles. In two dimensions, masses,
/// momenta, forces and energies are per metre of depth.
struct BodyDiagnostics {
  BodyId id;
  std::string name;
  Real mass;              ///< [kg]
  Vec3 center_of_mass;    ///< [m]
  Vec3 linear_momentum;   ///< [kg m/s]
  Vec3 angular_momentum;  ///< angular momentum about the world origin [kg m^2/s]
  /// Force of walls and other bodies, without projected contacts [N]. Gravity, the central field
  /// and the forces of users are excluded.
  Vec3 outer_force;
  /// Torque of `outer_force` and of the viscous forces, about the centre of mass [N m].
  Vec3 outer_torque;
  std::optional<Quat> orientation;       ///< only for rigid bodies
  std::optional<Vec3> angular_velocity;  ///< only for rigid bodies; world axes [rad/s]
};

/// Cost and residual of one linear solve of an incompressible liquid (see volume_solve.h).
struct SolveReport {
  int iterations = 0;
  /// Mean over the liquid particles of the relative density change above the permitted value. If
  /// the solve expected that its last iteration was sufficient, the residuals are expected values.
  Real mean = 0;
  Real greatest = 0;  ///< maximum over the liquid particles of the same quantity
};

/// Reports of the linear solves of the last step; see core/liquid/incompressible/volume_solve.h.
struct VolumeReport {
  SolveReport velocities;  ///< solve for the density change in one step
  SolveReport places;      ///< solve for the density above the rest density
};

/// Measurements of the current state. Measuring does not change the state.
struct Diagnostics {
  Real time;  ///< [s]
  std::vector<BodyDiagnostics> bodies;
  Real kinetic_energy;  ///< all particles and rigid bodies [J]
  /// Sum over all particles of -m g.x and of the energy m Omega^2 |x - center|^2 / 2 of the central
  /// field [J]. The value is 0 if the force `gravity` is switched off.
  Real gravitational_energy;
  Real elastic_energy;                 ///< static springs, and cells with a bulk modulus [J]
  Real contact_energy;                 ///< dynamic connections (contacts) and walls [J]
  Real mean_density_error;             ///< liquids: mean of max(0, rho/rho_0 - 1); 0 without liquid
  Real max_density_error;              ///< liquids: maximum of rho/rho_0 - 1, at least 0
  std::optional<VolumeReport> volume;  ///< only for incompressible liquids
  /// Sum of the torques about the axles of bodies [N m], without brakes, projected contacts and the
  /// pressure of incompressible liquids; only for scenes with axles.
  std::optional<Real> axle_torque;
  std::size_t torn_springs;         ///< number of static springs that have torn
  std::size_t particles_outside;    ///< number of particles beyond a wall of the vat
  std::size_t sleeping_bodies;      ///< number; see Scene::sleeping
  std::uint64_t emitted_particles;  ///< number since time 0
  std::uint64_t drained_particles;  ///< number since time 0
};

}  // namespace vat
