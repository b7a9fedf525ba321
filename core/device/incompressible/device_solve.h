#pragma once

#include <cstdint>
#include <memory>

#include "core/device/common/kernel_values.h"
#include "core/device/liquid/device_particles.h"
#include "core/device/liquid/liquid_geometry.h"
#include "core/device/opencl/program.h"
#include "core/diagnostics.h"
#include "core/liquid/incompressible/complementarity.h"

namespace vat {

/// The struct Solve of core/device/incompressible/solve.cl, with the same members in the same
/// order.
struct SolveParameters {
  double wall_velocity[3];     ///< mean over the step [m/s]
  double gravity[3];           ///< [m/s^2]
  double dt;                   ///< [s]; 1 in solves for positions
  double volume;               ///< rest volume / weight [m^3]
  double rate_factor;          ///< ds/dt / sum over pairs
  double acceleration_factor;  ///< acceleration / sum over pairs
  double diagonal_factor;      ///< diagonal / (dt^2 weight squares)
  double mean;                 ///< limit of the mean residual
  double greatest;             ///< limit of the greatest residual
  double start_mean;           ///< SolveLimits::start_mean
  double start_greatest;
  double first_reduction;  ///< SolveLimits::first_reduction
  double later_reduction;
  double negligible;   ///< x counts as 0 if x diagonal / scale is at most this
  double least_bound;  ///< see Complementarity
  double greatest_bound;
  double bound_of_optimal;
  double closing;  ///< see DensityRoom
  double left_alone;
  double removal;
  double max_expansion;  ///< kMaxExpansion
  double push_factor;    ///< force on a solid particle / (its weight times sum over pairs)
  double slope_scale;    ///< LiquidModel::slope_scale
  std::int32_t most_iterations;
  std::int32_t count;        ///< liquid particles
  std::int32_t slots;        ///< liquid and solid particles
  std::int32_t free;         ///< free solid particles
  std::int32_t solids_move;  ///< 1: the solve moves solids
};

/// The struct Progress of solve.cl, with the same members in the same order.
struct SolveProgress {
  double mean;
  double greatest;
  double mean_excess;      ///< mean of max(0, s - 1) for the relative density s
  double greatest_excess;  ///< maximum of the same quantity
  double square;
  double share;
  double slope;
  double length;
  double longest_step;
  std::int32_t iterations;
  std::int32_t is_open;
  std::int32_t restarts;
  std::int32_t is_last;
};

class DevicePushes;

/// Returns the parameters that do not depend on the step, for a model with one liquid.
SolveParameters solve_parameters(const Model& model);
void set_limits(const SolveLimits& limits, SolveParameters& parameters);

/// Solves a Complementarity on a device. The device ends a solve if its limits are met. Therefore,
/// the batches of the host do not change the number of iterations. The functions throw
/// opencl::DeviceFailure.
class DeviceSolve {
 public:
  DeviceSolve(opencl::Program& program, const Model& model);
  static std::size_t bytes_for(const Model& model);

  /// Iterates from the unknowns and excesses that begin_projection or begin_shift has computed. The
  /// sum `whole` of accelerations is then that of the change of x. `expected` is the expected
  /// number of iterations. `pushes` must be null if and only if the solve moves no solids.
  SolveReport solve(const LiquidParameters& p, const SolveParameters& solve,
                    const DeviceParticles& particles, DevicePushes* pushes, int expected);
  /// Computes and returns the excess density from the partial sums of find_density. The number of
  /// iterations is 0.
  SolveReport measure_excess();

  // Buffers by slot, see solve.cl.
  opencl::Buffer squares;
  opencl::Buffer solve_motion, whole;
  opencl::Buffer x, excess, gradient;
  opencl::Buffer partial;
  opencl::Buffer progress;

 private:
  void iterate(const LiquidParameters& p, const SolveParameters& solve,
               const DeviceParticles& particles, DevicePushes* pushes);
  void accelerate(const LiquidParameters& p, const SolveParameters& solve,
                  const DeviceParticles& particles, DevicePushes* pushes);
  SolveProgress read_progress();

  opencl::Program& program_;
  const std::size_t slots_;
  const std::int32_t count_;  ///< liquid particles
  const std::int32_t groups_;
  opencl::Buffer direction_, product_, charge_;
};

}  // namespace vat
