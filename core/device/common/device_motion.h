#pragma once

#include <vector>

#include "core/device/opencl/program.h"
#include "core/model/model.h"
#include "core/state/state.h"

namespace vat {

/// Positions and velocities of particles on a device, in their order. The functions
/// throw opencl::DeviceFailure.
class DeviceMotion {
 public:
  DeviceMotion(opencl::Program& program, std::size_t particles);

  /// Returns the bytes of a particle.
  static constexpr std::size_t kBytes = 6 * sizeof(double);

  /// Writes the motion of the particles of `from`, beginning with particle `first`.
  void write(const Configuration& from, std::size_t first = 0);
  void copy_from(const DeviceMotion& other);
  /// Moves liquid particles that have left a periodic world to the opposite side, as the CPU does
  /// after each nominal step. They are the first particles.
  void wrap_liquid(const Model& model);

  opencl::Buffer position;
  opencl::Buffer velocity;

 private:
  opencl::Program& program_;
  const std::size_t count_;
};

/// A copy of a DeviceMotion on the host. A reading that fails thus changes no state.
class ReadMotion {
 public:
  void read(opencl::Program& program, const DeviceMotion& from, std::size_t particles);
  /// Writes the copy to the particles of `to`, beginning with particle `first`.
  void copy_to(Configuration& to, std::size_t first = 0) const;

 private:
  std::vector<Vec3> positions_;
  std::vector<Vec3> velocities_;
};

}  // namespace vat
