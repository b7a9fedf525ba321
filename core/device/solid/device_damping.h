#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "core/device/common/device_cells.h"
#include "core/device/contact/solid_geometry.h"
#include "core/device/opencl/program.h"
#include "core/device/solid/device_rigid_bodies.h"
#include "core/device/solid/solid_tables.h"

namespace vat {

/// The struct Damping of damping.cl.
struct DampingParameters {
  double dt;
  double total_mass;
  double tolerance2;
  double velocity_tolerance2;
  std::int32_t count;
  std::int32_t most_iterations;
};

/// Returns the parameters of a solve for forces that act for `dt` [s] on `count` free particles.
DampingParameters damping_parameters(Real dt, Real total_mass, std::size_t count);

/// The struct DampingProgress of damping.cl.
struct DampingProgress {
  double error;
  double size;
  double permitted;
  double length;
  double share;
  std::int32_t iterations;
  std::int32_t is_open;
};

/// Calls iterate() until the device has ended a solve. `expected` is the number of iterations of
/// the last solve. Iterations after the end must have no effect. Returns the number of iterations.
template <class F>
int run_iterations(opencl::Program& program, const opencl::Buffer& progress_on_device, int expected,
                   F&& iterate) {
  constexpr int kFurther = 2;  // in a batch, if a solve needs more than expected
  DampingProgress progress{};
  int batch = std::max(1, expected);
  do {
    for (int n = 0; n < batch; ++n) iterate();
    program.read(progress_on_device, std::span(&progress, 1));
    batch = kFurther;
  } while (progress.is_open != 0);
  return progress.iterations;
}

/// Acting contacts and the directions of springs on a device, which a solve for damping uses again.
/// Small buffers that are not used if no force is damped.
struct RememberedForces {
  RememberedForces(opencl::Program& program, const Model& model);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model);

  std::int32_t is_used;
  opencl::Buffer contact_counts, contacts;  ///< see ContactLists of forces.cl
  opencl::Buffer ways;                      ///< by end of springs
};

/// The present particles of bodies on a device, for sums over their neighbours.
struct PlacedSolids {
  const SolidTables& tables;
  const DeviceCells& cells;
  const opencl::Buffer& order;
  const opencl::Buffer& sorted;  ///< see particles.cl
  const opencl::Buffer& position;
  const opencl::Buffer& velocity;
  const opencl::Buffer& predicted;  ///< velocities in forces
  const DeviceRigidBodies& rigid;
  const RememberedForces& memory;            ///< of the last forces
  const opencl::Buffer& contact_mobilities;  ///< only for restitution
};

/// Converts forces to those at the velocities after a step, as solve_damping(), on a device. The
/// device ends a solve if a tolerance is met. Therefore, the batches of the host do not change the
/// number of iterations. The functions throw opencl::DeviceFailure.
class DeviceDamping {
 public:
  DeviceDamping(opencl::Program& program, const Model& model);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model);

  /// Sums the masses of the particles and bodies that can move in this step.
  void find_mass(const Model& model, std::uint64_t step);
  /// Changes the forces on particles, `force`, and on rigid bodies. The forces act for `dt` [s].
  /// `p` are the parameters of the forces. Returns the number of iterations.
  std::uint32_t solve(const SolidParameters& p, const PlacedSolids& solids, Real dt,
                      const opencl::Buffer& force);

 private:
  void begin(const DampingParameters& damping, const PlacedSolids& solids,
             const opencl::Buffer& force);
  void iterate(const SolidParameters& p, const DampingParameters& damping,
               const PlacedSolids& solids);

  opencl::Program& program_;
  const std::size_t free_;    ///< free solid particles
  const std::size_t count_;   ///< all solid particles
  const std::size_t bodies_;  ///< rigid bodies
  Real total_mass_ = 0;       ///< of the particles and rigid bodies that can move [kg]
  int expected_ = 1;          ///< iterations of the last solve
  opencl::Buffer change_, change_of_force_, residual_, direction_, multiplied_;
  opencl::Buffer torque_;       ///< of friction, by particle
  opencl::Buffer spin_change_;  ///< of the direction, by body of the scene
  opencl::Buffer partial_, momenta_, progress_;
};

}  // namespace vat
