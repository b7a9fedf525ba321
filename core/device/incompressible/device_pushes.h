#pragma once

#include <cstddef>
#include <cstdint>

#include "core/device/incompressible/device_solve.h"
#include "core/device/liquid/device_particles.h"
#include "core/device/liquid/liquid_geometry.h"
#include "core/device/opencl/program.h"
#include "core/device/solid/device_solids.h"
#include "core/model/model.h"

namespace vat {

/// The part of moving solids in solves for the velocities of an incompressible liquid, see
/// core/device/incompressible/solids.cl. The functions throw opencl::DeviceFailure.
class DevicePushes {
 public:
  /// `solids` must outlive this object.
  DevicePushes(opencl::Program& program, const Model& model, const DeviceSolids& solids);
  static std::size_t bytes_for(const Model& model);

  /// Writes the mobilities of the particles in `step`.
  void find_mobilities(const Model& model, std::uint64_t step);

  /// Sets the motions of solids to their velocities. Adds the mobilities of solids to the squares
  /// of find_density. Both precede a solve for velocities or positions.
  void see_solids(const LiquidParameters& p, const SolveParameters& solve,
                  const DeviceParticles& particles, const opencl::Buffer& solve_motion,
                  const opencl::Buffer& squares);
  /// Begins a solve with total forces of 0.
  void begin();
  /// Accelerates rigid bodies and their particles by the forces on the particles. Writes the
  /// curvatures to `partial` behind `groups` others.
  void accelerate_bodies(const SolveParameters& solve, const DeviceParticles& particles,
                         std::int32_t groups, const opencl::Buffer& progress,
                         const opencl::Buffer& solve_motion, const opencl::Buffer& partial);
  /// Adds the forces of an iteration to the total forces.
  void add(const SolveParameters& solve, const opencl::Buffer& progress);
  /// Changes the velocities by the total forces.
  void kick(const SolveParameters& solve, const opencl::Buffer& progress);

  /// Returns the number of curvatures of accelerate_bodies().
  std::int32_t bodies() const { return static_cast<std::int32_t>(bodies_); }
  const opencl::Buffer& mobility() const { return solids_.placed().tables.mobility; }
  const opencl::Buffer& push() const { return push_; }

 private:
  opencl::Program& program_;
  const DeviceSolids& solids_;
  const std::size_t free_;    ///< free particles
  const std::size_t count_;   ///< all particles
  const std::size_t bodies_;  ///< rigid bodies
  opencl::Buffer roots_;      ///< roots of mobilities [kg^(-1/2)]
  opencl::Buffer push_, total_;
  opencl::Buffer acceleration_;  ///< linear and angular, by rigid body
};

}  // namespace vat
