#pragma once

#include <cstddef>
#include <vector>

#include "core/device/common/device_motion.h"
#include "core/device/opencl/program.h"
#include "core/model/model.h"
#include "core/stepping/step_engine.h"

namespace vat {

/// Finds the motion of the bodies of a model that are not rigid; see body_motions.cl. The
/// functions throw opencl::DeviceFailure.
class DeviceBodyMotions {
 public:
  /// `first` is the index of the first particle on the device in the model.
  DeviceBodyMotions(opencl::Program& program, const Model& model, std::size_t first);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model);

  /// Reads the present motion of each body of the scene.
  void read(const DeviceMotion& motion, std::vector<ParticleMotion>& motions);

 private:
  opencl::Program& program_;
  const std::size_t bodies_;
  const bool has_free_bodies_;
  opencl::Buffer ranges_;   ///< first and last particle of each body; empty for rigid bodies
  opencl::Buffer motions_;  ///< kValues of each body
  std::vector<double> read_;
};

}  // namespace vat
