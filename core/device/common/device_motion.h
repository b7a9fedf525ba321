#pragma once

#include <vector>

#include "core/device/opencl/program.h"
#include "core/state/state.h"

namespace vat {

/// Positions and velocities of a liquid on a device, in the order of the particles. The functions
/// throw opencl::DeviceFailure.
class DeviceMotion {
 public:
  DeviceMotion(opencl::Program& program, std::size_t particles);

  /// Returns the bytes of a particle.
  static constexpr std::size_t kBytes = 6 * sizeof(double);

  /// Writes the motion of the first particles of `from`.
  void write(const Configuration& from);
  void copy_from(const DeviceMotion& other);

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
  /// Writes the copy to the first particles of `to`.
  void copy_to(Configuration& to) const;

 private:
  std::vector<Vec3> positions_;
  std::vector<Vec3> velocities_;
};

}  // namespace vat
