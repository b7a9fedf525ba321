#pragma once

#include <cstddef>

#include "core/device/contact/solid_geometry.h"
#include "core/device/opencl/program.h"
#include "core/device/solid/device_damping.h"
#include "core/model/model.h"

namespace vat {

/// The mobilities of contacts on a device, for the dashpots of a restitution; see restitution.cl.
/// The functions throw opencl::DeviceFailure.
class DeviceRestitution {
 public:
  DeviceRestitution(opencl::Program& program, const Model& model);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model);

  /// Computes the mobilities at the present positions.
  void find(const SolidParameters& p, const PlacedSolids& solids);

  /// Returns the mobilities by particle.
  const opencl::Buffer& mobilities() const { return mobilities_; }

 private:
  opencl::Program& program_;
  const std::size_t count_;           ///< solid particles
  const std::size_t bodies_;          ///< rigid bodies
  opencl::Buffer direction_;          ///< sums of normals, by particle
  opencl::Buffer changes_of_bodies_;  ///< of velocities by unit impulses
  opencl::Buffer mobilities_;
};

}  // namespace vat
