#pragma once

#include <vector>

#include "core/device/opencl/program.h"
#include "core/guard/guard.h"
#include "core/model/model.h"

namespace vat {

/// Returns the springs of a model, with indices of particles in SolidRange.
std::vector<SpringEnd> springs_on_device(const Model& model);

/// The constants of deformable and rigid bodies on a device: particles, bodies,
/// contact laws, springs and cells. Throws opencl::DeviceFailure.
class SolidTables {
 public:
  SolidTables(opencl::Program& program, const Model& model, const GuardBounds& bounds);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model);

  // Buffers, see particles.cl and forces.cl. By particle:
  opencl::Buffer mass, mobility, radius, body_of;
  opencl::Buffer bodies;
  opencl::Buffer laws;  ///< between materials, within bodies, with walls
  // By particle, the excluded particles, springs and corners of cells:
  opencl::Buffer exclusion_begin, exclusions;
  opencl::Buffer spring_begin;
  opencl::Buffer springs;  ///< with present rest lengths, see DeviceSpringChanges
  opencl::Buffer corner_begin, corners;
  opencl::Buffer cells;
};

}  // namespace vat
