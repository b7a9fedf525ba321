#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/device/incompressible/device_pushes.h"
#include "core/device/liquid/device_particles.h"
#include "core/device/liquid/liquid_geometry.h"
#include "core/device/opencl/program.h"
#include "core/device/solid/device_solids.h"
#include "core/device/solid/device_step_limits.h"
#include "core/model/model.h"
#include "core/state/state.h"

namespace vat {

/// Moving solids in an incompressible liquid, and their parts in solves for velocities and in step
/// control. The functions throw opencl::DeviceFailure.
class WetSolids {
 public:
  /// `model` must outlive this object.
  WetSolids(opencl::Program& program, const Model& model);
  static std::size_t bytes_for(const Model& model);

  void write(const State& state);
  /// Finds which bodies are held in `step`.
  void release(std::uint64_t step);
  /// Finds the forces at `time` [s] after find_solid_pressure(). `p` are the parameters of the
  /// liquid at this time.
  void find_forces(Real time, const LiquidParameters& p, DeviceParticles& particles);

  DeviceSolids solids;
  DevicePushes pushes;
  std::optional<DeviceStepLimits> limits;  ///< only with adaptive steps

 private:
  void find_mobilities(std::uint64_t step);

  const Model& model_;
};

}  // namespace vat
