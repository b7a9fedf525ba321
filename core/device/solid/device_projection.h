#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/device/common/device_cells.h"
#include "core/device/common/device_motion.h"
#include "core/device/contact/solid_geometry.h"
#include "core/device/opencl/program.h"
#include "core/device/solid/device_rigid_bodies.h"
#include "core/device/solid/solid_tables.h"
#include "core/model/model.h"
#include "core/stage/advance_report.h"
#include "core/state/state.h"

namespace vat {

/// The bodies that contacts by projection move, and their cells.
struct ProjectedSolids {
  const SolidTables& tables;
  DeviceMotion& motion;
  DeviceRigidBodies& rigid;
  DeviceCells& cells;
  const opencl::Buffer& order;
  const opencl::Buffer& sorted;
  const opencl::Buffer& predicted;  ///< overwritten
};

/// Contacts by projection on a device, see projection.cl: ContactProjection without Newton's
/// method. If the sweeps of an island do not converge, the step fails. The functions throw
/// opencl::DeviceFailure.
class DeviceProjection {
 public:
  /// For a model with contacts by projection.
  DeviceProjection(opencl::Program& program, const Model& model);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model);

  /// Writes the forces of the last step.
  void write(const Configuration& from);
  /// Reads these forces. The function copy_to() then writes them.
  void read();
  void copy_to(Configuration& to) const;
  /// Saves the present forces, or returns to the saved ones. save() also begins the count of
  /// iterations.
  void save();
  void restore();

  /// Moves the bodies from `start` over `dt` [s]. `p` are the parameters at the end of the step.
  void drift(const Model& model, const SolidParameters& p, Real start, Real dt,
             const ProjectedSolids& solids, const opencl::Buffer& counters);
  /// Changes the velocities at the end of a step of `dt` at the time `end` [s].
  void finish(const Model& model, const SolidParameters& p, Real end, Real dt,
              const ProjectedSolids& solids, const opencl::Buffer& counters);

  /// Returns the positions at the start of the last drift.
  const opencl::Buffer& start_position() const { return start_position_; }

  /// Adds the iterations since save() to a report.
  void count(AdvanceReport& report);

 private:
  /// The struct ContactRecord of projection.cl.
  struct Record {
    double drift[3];
    double finish[3];
    std::int32_t particle;
    std::int32_t other;
    std::int32_t is_steady;
    std::int32_t is_present;
  };
  /// The struct Projection of projection.cl.
  struct Progress {
    std::int32_t count;
    std::int32_t recorded;
    std::int32_t present;
    std::int32_t unsolved;
    std::int32_t unmet;
    std::int32_t iterations;
    std::int32_t islands;
    std::int32_t padding;
    std::uint64_t all_iterations;
  };
  /// The struct ProjectionStep of projection.cl.
  struct Step {
    double dt;
    double margin;
    double reach;
    double slow;
    double vat_offset[3];
    double wall_velocity[3];
    std::int32_t capacity;
    std::int32_t is_finish;
  };

  Progress read_progress();
  Step step_of(const Model& model, Real time, Real dt, bool is_finish) const;
  void predict(const SolidParameters& p, Real dt, const ProjectedSolids& solids,
               const opencl::Buffer& counters);
  /// Finds the contacts of the predicted positions. Returns their number.
  std::size_t find(const SolidParameters& p, const Step& step, const ProjectedSolids& solids,
                   const opencl::Buffer& counters);
  void set_geometry(const SolidParameters& p, const Step& step, const ProjectedSolids& solids,
                    const opencl::Buffer& position, const opencl::Buffer& poses);
  void find_islands();
  void sweep(const Step& step, bool is_first, const ProjectedSolids& solids);

  opencl::Program& program_;
  const std::size_t first_;      ///< index of the first particle in the model
  const std::size_t free_;       ///< free particles
  const std::size_t particles_;  ///< all particles
  const std::size_t bodies_;     ///< rigid bodies
  const std::size_t capacity_;   ///< contacts
  std::size_t count_ = 0;        ///< contacts of the present step
  DevicePrefixSums sums_;
  opencl::Buffer laws_, counts_, begins_, contacts_;
  opencl::Buffer records_, saved_records_, progress_;
  opencl::Buffer start_position_, start_poses_, motions_, predicted_motions_;
  opencl::Buffer parents_, island_of_, is_hit_, island_begins_, members_;
  std::vector<Record> read_records_;
  std::size_t saved_count_ = 0;
};

}  // namespace vat
