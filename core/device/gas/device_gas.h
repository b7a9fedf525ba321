#pragma once

#include <cstddef>

#include "core/device/opencl/program.h"
#include "core/device/solid/device_solids.h"
#include "core/model/model.h"

namespace vat {

/// The forces within gas-like liquids on a device. Their particles are the first of the bodies of
/// DeviceSolids. The functions throw opencl::DeviceFailure.
class DeviceGas {
 public:
  DeviceGas(opencl::Program& program, const Model& model);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model);

  /// Adds the forces at the time `end` [s] to those of DeviceSolids::find_forces().
  void add_forces(const Model& model, const DeviceSolids& bodies, Real end);

 private:
  opencl::Program& program_;
  opencl::Buffer gases_;                                  ///< constants by material
  opencl::Buffer volume_and_pressure_, sorted_velocity_;  ///< in the order of cells
};

}  // namespace vat
