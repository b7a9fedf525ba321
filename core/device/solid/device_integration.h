#pragma once

#include <cstddef>

#include "core/device/common/device_motion.h"
#include "core/device/contact/solid_geometry.h"
#include "core/device/opencl/program.h"
#include "core/device/solid/device_rigid_bodies.h"
#include "core/device/solid/solid_tables.h"
#include "core/model/model.h"

namespace vat {

/// The bodies that a step moves, and the forces on their particles.
struct SteppedSolids {
  const DeviceMotion& motion;
  const opencl::Buffer& force;
  const SolidTables& tables;
  const DeviceRigidBodies& rigid;
};

/// Steps of integrators without a closing kick on a device, see integrators.cl. The forces of each
/// stage must be known. The functions throw opencl::DeviceFailure.
class DeviceIntegration {
 public:
  DeviceIntegration(opencl::Program& program, const Model& model);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model);

  /// Takes a step of symplectic Euler of `dt` [s], in which the kick of particles lasts `kick` [s].
  /// `p` are the parameters at its end.
  void take_euler_step(const SolidParameters& p, Real kick, Real dt, const SteppedSolids& solids,
                       const opencl::Buffer& counters);
  /// Begins a Runge-Kutta step.
  void begin(const SteppedSolids& solids);
  /// Adds `weight` times the present rates to the step, and moves to the next stage: `way` [s]
  /// times the rates after the start of the step.
  void advance(Real weight, Real way, const SteppedSolids& solids);
  /// Ends a Runge-Kutta step of `dt` [s]. `p` are the parameters at its end.
  void end(const SolidParameters& p, Real dt, const SteppedSolids& solids,
           const opencl::Buffer& counters);

 private:
  opencl::Program& program_;
  const std::size_t free_;    ///< free particles
  const std::size_t bodies_;  ///< rigid bodies
  DeviceMotion start_, sum_;  ///< the sums of velocities and accelerations
  opencl::Buffer start_poses_, sum_of_rates_;
};

}  // namespace vat
