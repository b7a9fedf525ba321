#pragma once

#include <vector>

#include "core/device/opencl/program.h"
#include "core/model/model.h"

namespace vat {

/// The liquid particles in the tubes of emitters, which keep their velocities. The functions throw
/// opencl::DeviceFailure.
class DeviceNozzles {
 public:
  /// Returns whether a particle is in a tube.
  static bool has_particles(const Model& model);
  /// The model must have such a particle.
  DeviceNozzles(opencl::Program& program, const Model& model);
  static std::size_t bytes_for(const Model& model);

  /// Removes the accelerations of these particles.
  void hold(const opencl::Buffer& acceleration);

 private:
  opencl::Program& program_;
  const std::vector<std::int32_t> particles_;
  opencl::Buffer buffer_;
};

}  // namespace vat
