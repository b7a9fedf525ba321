#pragma once

#include <cstddef>
#include <optional>

#include "core/device/common/device_motion.h"
#include "core/device/liquid/liquid_geometry.h"
#include "core/device/opencl/program.h"
#include "core/model/model.h"

namespace vat {

/// The liquid that a step moves, and its rates.
struct SteppedLiquid {
  const DeviceMotion& motion;
  const opencl::Buffer& acceleration;
  const opencl::Buffer* transport;  ///< null without transport velocities
};

/// Steps of a weakly compressible liquid by integrators without a closing kick on a device, see
/// tait/integrators.cl. The rates of each stage must be known. The functions throw
/// opencl::DeviceFailure.
class DeviceLiquidIntegration {
 public:
  DeviceLiquidIntegration(opencl::Program& program, const Model& model);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model);

  /// Takes a step of symplectic Euler of `dt` [s]. `p` are the parameters at its end.
  void take_euler_step(const LiquidParameters& p, Real dt, const SteppedLiquid& liquid,
                       const opencl::Buffer& counters);
  /// Begins a Runge-Kutta step.
  void begin(const SteppedLiquid& liquid);
  /// Adds `weight` times the present rates to the step, and moves to the next stage: `way` [s]
  /// times the rates after the start of the step.
  void advance(Real weight, Real way, const SteppedLiquid& liquid);
  /// Ends a Runge-Kutta step of `dt` [s]. `p` are the parameters at its end.
  void end(const LiquidParameters& p, Real dt, const SteppedLiquid& liquid,
           const opencl::Buffer& counters);

 private:
  opencl::Program& program_;
  const std::size_t count_;   ///< liquid particles
  DeviceMotion start_, sum_;  ///< the sums of velocities and accelerations
};

}  // namespace vat
