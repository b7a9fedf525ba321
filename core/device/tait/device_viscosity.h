#pragma once

#include <cstddef>
#include <cstdint>

#include "core/device/liquid/device_particles.h"
#include "core/device/liquid/liquid_geometry.h"
#include "core/device/opencl/program.h"
#include "core/model/model.h"

namespace vat {

/// The solve for the viscosity of a weakly compressible liquid between walls and solids at rest, as
/// solve_damping(), on a device. The functions throw opencl::DeviceFailure.
class DeviceViscosity {
 public:
  DeviceViscosity(opencl::Program& program, const Model& model);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model);

  /// Converts the `acceleration` of the sorted `particles` to that at the velocities after it has
  /// acted for `dt` [s]. `p` are the parameters of the forces, and `velocity` are the velocities
  /// before the forces act. Returns the number of iterations.
  std::uint32_t solve(const LiquidParameters& p, const DeviceParticles& particles,
                      const opencl::Buffer& velocity, Real dt, const opencl::Buffer& acceleration);

 private:
  opencl::Program& program_;
  const std::size_t count_;  ///< liquid particles
  Real total_mass_ = 0;      ///< of the liquid [kg]
  int expected_ = 1;         ///< iterations of the last solve
  opencl::Buffer mass_, mobility_;
  opencl::Buffer predicted_, force_;
  opencl::Buffer change_, change_of_force_, residual_, direction_, multiplied_;
  opencl::Buffer sorted_direction_;
  opencl::Buffer partial_, momenta_, progress_;
};

}  // namespace vat
