#pragma once

#include <cstdint>

#include "core/device/opencl/program.h"

namespace vat {

/// Prefix sums of a fixed number of integers on a device.
class DevicePrefixSums {
 public:
  DevicePrefixSums(opencl::Program& program, std::size_t count);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(std::size_t count);

  /// Sets `begins` to the sums of the preceding `values`, and to the total behind the last one.
  void sum(const opencl::Buffer& values, const opencl::Buffer& begins);

 private:
  opencl::Program& program_;
  const std::size_t count_;
  opencl::Buffer block_sums_;
};

/// Cells with particles on a device, and the particles in the order of their cells. The functions
/// throw opencl::DeviceFailure.
class DeviceCells {
 public:
  DeviceCells(opencl::Program& program, std::size_t particles, std::size_t cells);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(std::size_t particles, std::size_t cells);

  /// Removes all particles from the cells.
  void clear();
  /// Computes `begins` and `unsorted` from the cells of all particles.
  void sort();

  /// Returns the number of particles.
  std::size_t count() const { return count_; }

  // Buffers, see cells.cl.
  opencl::Buffer begins;    ///< start of each cell in the order of cells, and the end of the last
  opencl::Buffer cell_of;   ///< cell of each particle
  opencl::Buffer rank;      ///< of each particle in its cell, in the order of its entry
  opencl::Buffer counts;    ///< number of particles of each cell
  opencl::Buffer unsorted;  ///< particles in the order of cells; within a cell in any order

 private:
  opencl::Program& program_;
  const std::size_t count_;
  const std::size_t cells_;
  DevicePrefixSums sums_;
};

}  // namespace vat
