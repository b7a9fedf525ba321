#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/device/liquid/liquid_geometry.h"
#include "core/device/opencl/program.h"
#include "core/model/model.h"

namespace vat {

/// A vector of four numbers of a kernel.
struct Float4 {
  float x, y, z, w;
};

/// Counters of the kernels, in the order of particles.cl.
struct Counters {
  std::int32_t faults = 0;
  std::int32_t stops = 0;
};

/// The particles of a liquid on a device, in the order of their cells, and their neighbours. The
/// functions throw opencl::DeviceFailure.
class DeviceParticles {
 public:
  /// Allocates the buffers for a model, and writes the weights of the particles.
  DeviceParticles(opencl::Program& program, const Model& model, const LiquidGeometry& geometry);

  /// Returns the bytes of the buffers on the device.
  static std::size_t bytes_for(const Model& model, const LiquidGeometry& geometry);

  /// Runs the kernel `name`, which enters the particles into their cells. Then sorts the particles.
  /// The arguments of the kernel are `own` and the buffers of enter_cell().
  template <class... Arguments>
  void sort_after(const char* name, const Arguments&... own) {
    program_.fill_with_zeros(cell_counts_, cells_ * sizeof(std::int32_t));
    program_.run(name, count_, own..., weight_, place_, motion_, cell_of_, rank_, cell_counts_,
                 counters);
    sort();
  }

  /// Resets the counters.
  void clear_counters();
  /// Waits for all commands, and returns the counters.
  Counters read_counters();

  const opencl::Buffer& weight() const { return weight_; }

  // Buffers in the order of cells, see pairs.cl.
  opencl::Buffer order;
  opencl::Buffer sorted_place;
  opencl::Buffer sorted_motion;
  opencl::Buffer neighbour_counts;
  opencl::Buffer neighbours;
  opencl::Buffer cell_begins;
  opencl::Buffer counters;

 private:
  void sort();

  opencl::Program& program_;
  const std::size_t count_;
  const std::size_t cells_;
  opencl::Buffer weight_, place_, motion_, cell_of_, rank_;  // in the order of particles
  opencl::Buffer unsorted_, cell_counts_, block_sums_;
};

}  // namespace vat
