#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/device/common/device_cells.h"
#include "core/device/common/device_counters.h"
#include "core/device/liquid/liquid_geometry.h"
#include "core/device/opencl/program.h"
#include "core/model/model.h"
#include "core/state/state.h"

namespace vat {

/// A vector of four numbers of a kernel.
struct Float4 {
  float x, y, z, w;
};

/// The positions and velocities of moving solids, in the order of their particles.
struct MovingSolids {
  const opencl::Buffer& position;
  const opencl::Buffer& velocity;
};

/// Returns the slots of buffers that the kernels of lanes.cl read or write in vectors.
std::size_t slots_in_lanes(std::size_t particles);

/// The particles of a liquid and of the solids in it, on a device. They are in the order of
/// their cells, with lists of their neighbours. The functions throw opencl::DeviceFailure.
class DeviceParticles {
 public:
  /// Allocates the buffers for a model, and writes the weights of the particles. Solids are at rest
  /// without `moving`.
  DeviceParticles(opencl::Program& program, const Model& model, const LiquidGeometry& geometry,
                  std::optional<MovingSolids> moving = {});

  /// Returns the bytes of the buffers on the device.
  static std::size_t bytes_for(const Model& model, const LiquidGeometry& geometry,
                               bool solids_move = false);

  /// Writes the positions of solids at rest.
  void write_solids(const Configuration& from);

  /// Runs the kernel `name`, which enters the liquid particles into their cells. Then enters the
  /// solids, and sorts all particles. The arguments of the kernel are `own` and the buffers of
  /// enter_cell().
  template <class... Arguments>
  void sort_after(const char* name, const LiquidParameters& p, const Arguments&... own) {
    cells.clear();
    program_.run(name, liquid_count_, p, own..., weight_, place_, motion_, cells.cell_of,
                 cells.rank, cells.counts, counters.buffer);
    enter_solids(p);
    sort();
  }
  /// Runs a kernel over pairs of all particles, with the table of liquids if there is one.
  template <class... Arguments>
  void run_over_pairs(const char* name, const Arguments&... arguments) {
    if (has_table_) {
      program_.run(name, count_, arguments..., liquids_, liquid_in_);
    } else {
      program_.run(name, count_, arguments...);
    }
  }
  /// The same with run_in_lanes().
  template <class... Arguments>
  void run_over_pairs_in_lanes(const char* name, const Arguments&... arguments) {
    if (has_table_) {
      run_over_pairs(name, arguments...);  // programs with a table have one lane
    } else {
      program_.run_in_lanes(name, count_, arguments...);
    }
  }
  /// Extrapolates the pressure to the solids, if there are any.
  void find_solid_pressure(const LiquidParameters& p);
  /// Adds the forces of the liquid on solids to `force`, after find_solid_pressure().
  void add_forces_on_solids(const LiquidParameters& p, const opencl::Buffer& force);

  /// Returns the number of liquid and solid particles.
  std::size_t count() const { return count_; }

  const opencl::Buffer& weight() const { return weight_; }

  // Buffers in the order of cells, see pairs.cl.
  opencl::Buffer order;
  opencl::Buffer sorted_place;
  opencl::Buffer sorted_motion;
  opencl::Buffer density;  ///< relative to the density at rest
  opencl::Buffer neighbour_counts;
  opencl::Buffer neighbours;

  // Only on devices with several lanes, see lanes.cl.
  opencl::Buffer columns;       ///< of sorted_place
  opencl::Buffer plain_counts;  ///< neighbours that are no images
  opencl::Buffer selected;      ///< kSelectedLanes
  DeviceCells cells;
  DeviceCounters counters;

 private:
  void write_table(const Model& model);
  void enter_solids(const LiquidParameters& p);
  void sort();

  opencl::Program& program_;
  const std::size_t liquid_count_;
  const std::size_t count_;
  opencl::Buffer weight_, place_, motion_;  // in the order of particles
  const std::optional<MovingSolids> moving_;
  opencl::Buffer solid_position_;  ///< only with solids at rest
  const bool has_table_;
  opencl::Buffer liquids_, liquid_of_, liquid_in_;  ///< table, and its indices by particle and slot
};

}  // namespace vat
