#include "core/device/solid/device_damping.h"

#include <algorithm>
#include <span>

#include "core/damping/damping_solve.h"
#include "core/device/common/kernel_values.h"

namespace vat {
namespace {

using opencl::Program;

constexpr int kFurtherIterations = 2;  // in a batch, if a solve needs more than expected
constexpr std::size_t kColumn = 3 * sizeof(double);

// Structs of damping.cl.
struct DampingParameters {
  double dt;
  double total_mass;
  double tolerance2;
  double velocity_tolerance2;
  std::int32_t count;
  std::int32_t most_iterations;
};
struct DampingProgress {
  double error;
  double size;
  double permitted;
  double length;
  double share;
  std::int32_t iterations;
  std::int32_t is_open;
};

DampingParameters damping_parameters(Real dt, Real total_mass, std::size_t free) {
  return {dt,
          total_mass,
          kDampingTolerance * kDampingTolerance,
          kDampingVelocityTolerance * kDampingVelocityTolerance,
          static_cast<std::int32_t>(free),
          kMaxDampingPasses};
}

std::size_t bytes_of_sums(std::size_t particles) {
  return static_cast<std::size_t>(groups_of(particles)) * 4 * sizeof(double);
}

}  // namespace

DeviceDamping::DeviceDamping(Program& program, const Model& model)
    : program_(program),
      free_(model.free_count),
      count_(model.particle_count),
      change_(program, free_ * kColumn),
      change_of_force_(program, free_ * kColumn),
      residual_(program, free_ * kColumn),
      direction_(program, free_ * kColumn),
      multiplied_(program, free_ * kColumn),
      partial_(program, bytes_of_sums(count_)),
      momenta_(program, bytes_of_sums(count_)),
      progress_(program, sizeof(DampingProgress)) {
  for (std::size_t i = 0; i < free_; ++i) {
    if (model.inverse_mass[i] > 0) total_mass_ += model.mass[i];
  }
}

std::size_t DeviceDamping::bytes_for(const Model& model) {
  return 5 * model.free_count * kColumn + 2 * bytes_of_sums(model.particle_count) +
         sizeof(DampingProgress);
}

void DeviceDamping::iterate(const SolidParameters& p, const PlacedSolids& solids, Real dt) {
  const DampingParameters damping = damping_parameters(dt, total_mass_, free_);
  const SolidTables& t = solids.tables;
  constexpr std::size_t kOne = Program::kGroup;
  program_.run("turn_damping", free_, damping, progress_, t.mobility, residual_, direction_);
  program_.run("multiply_damping", count_, p, damping, progress_, solids.cells.begins, solids.order,
               solids.sorted_position, solids.position, solids.predicted, direction_, t.mass,
               t.radius, t.body_of, t.bodies, t.laws, t.exclusion_begin, t.exclusions,
               t.spring_begin, t.springs, multiplied_, partial_);
  program_.run("find_damping_length", kOne, groups_of(count_), partial_, progress_);
  program_.run("advance_damping", free_, damping, progress_, t.mass, t.mobility, direction_,
               multiplied_, change_, change_of_force_, residual_, partial_);
  program_.run("end_damping_iteration", kOne, damping, groups_of(free_), partial_, progress_);
}

std::uint32_t DeviceDamping::solve(const SolidParameters& p, const PlacedSolids& solids, Real dt,
                                   const opencl::Buffer& force) {
  const DampingParameters damping = damping_parameters(dt, total_mass_, free_);
  const SolidTables& t = solids.tables;
  program_.run("begin_damping", free_, damping, t.mass, t.mobility, solids.predicted, force,
               change_, change_of_force_, residual_, direction_, partial_, momenta_);
  program_.run("open_damping", Program::kGroup, damping, groups_of(free_), partial_, momenta_,
               progress_);
  DampingProgress progress{};
  int batch = std::max(1, expected_);
  do {
    // Iterations after the end of a solve have no effect.
    for (int n = 0; n < batch; ++n) iterate(p, solids, dt);
    program_.read(progress_, std::span(&progress, 1));
    batch = kFurtherIterations;
  } while (progress.is_open != 0);
  program_.run("end_damping", free_, damping, change_of_force_, force);
  expected_ = progress.iterations;
  return static_cast<std::uint32_t>(progress.iterations);
}

}  // namespace vat
