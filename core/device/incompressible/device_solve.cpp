#include "core/device/incompressible/device_solve.h"

#include <algorithm>

#include "core/liquid/incompressible/solve_limits.h"
#include "core/liquid/pairs/coupled_pairs.h"

namespace vat {
namespace {

using opencl::Program;

constexpr int kNextIterations = 4;  // in further batches, if a solve needs more than expected

}  // namespace

SolveParameters solve_parameters(const Model& model) {
  const LiquidModel& liquid = *model.liquids[model.material[0]];
  const DensityRoom room = density_room(model.scene.incompressible);
  SolveParameters p{};
  p.volume = 1 / liquid.kernel.scale();
  p.rate_factor = slope_factor(model, liquid) / liquid.slope_scale;
  p.acceleration_factor = slope_factor(model, liquid) / liquid.rest_density;
  p.diagonal_factor =
      p.volume * p.rate_factor * p.rate_factor * liquid.slope_scale / liquid.rest_density;
  p.least_bound = Complementarity::kLeastBound;
  p.greatest_bound = Complementarity::kGreatestBound;
  p.bound_of_optimal = Complementarity::kBoundOfOptimal;
  p.closing = room.closing;
  p.left_alone = room.left_alone;
  p.removal = room.removal;
  p.max_expansion = kMaxExpansion;
  p.count = static_cast<std::int32_t>(model.liquid_count);
  p.slots = static_cast<std::int32_t>(model.particle_count);
  return p;
}

void set_limits(const SolveLimits& limits, SolveParameters& p) {
  p.mean = limits.mean;
  p.greatest = limits.greatest;
  p.start_mean = limits.start_mean;
  p.start_greatest = limits.start_greatest;
  p.first_reduction = limits.first_reduction;
  p.later_reduction = limits.later_reduction;
  p.negligible = Complementarity::kNegligible * limits.mean;
  p.most_iterations = limits.most_iterations;
}

DeviceSolve::DeviceSolve(Program& program, const Model& model)
    : squares(program, model.particle_count * sizeof(float)),
      solve_motion(program, slots_in_lanes(model.particle_count) * sizeof(Float4)),
      whole(program, model.particle_count * sizeof(Float4)),
      x(program, model.particle_count * sizeof(double)),
      excess(program, model.particle_count * sizeof(double)),
      gradient(program, model.particle_count * sizeof(double)),
      partial(program, bytes_of_partial(model.particle_count)),
      progress(program, sizeof(SolveProgress)),
      program_(program),
      slots_(model.particle_count),
      count_(static_cast<std::int32_t>(model.liquid_count)),
      groups_(groups_of(slots_)),
      direction_(program, slots_ * sizeof(double)),
      product_(program, slots_ * sizeof(double)),
      charge_(program, slots_in_lanes(slots_) * sizeof(Float4)) {}

std::size_t DeviceSolve::bytes_for(const Model& model) {
  const std::size_t n = model.particle_count;
  return n * (5 * sizeof(double) + sizeof(Float4) + sizeof(float)) +
         slots_in_lanes(n) * 2 * sizeof(Float4) + bytes_of_partial(n) + sizeof(SolveProgress);
}

void DeviceSolve::iterate(const LiquidParameters& p, const SolveParameters& solve,
                          const DeviceParticles& s) {
  constexpr std::size_t kOne = Program::kGroup;
  for (const std::int32_t is_restart : {0, 1}) {
    program_.run("follow", slots_, solve.slots, is_restart, progress, x, excess, gradient,
                 direction_, charge_, partial);
    program_.run("find_slope", kOne, groups_, is_restart, partial, progress);
  }
  program_.run_in_lanes("accelerate", slots_, p, solve, progress, s.cells.begins, s.sorted_place,
                        s.neighbour_counts, s.plain_counts, s.neighbours, charge_, solve_motion,
                        partial);
  program_.run("find_length", kOne, solve, groups_, partial, progress);
  program_.run_in_lanes("compress", slots_, p, solve, progress, s.cells.begins, s.sorted_place,
                        s.neighbour_counts, s.plain_counts, s.neighbours, solve_motion, product_);
  program_.run("take_step", slots_, solve, progress, s.sorted_place, squares, direction_, product_,
               solve_motion, x, excess, gradient, whole, partial);
  program_.run("end_iteration", kOne, solve, groups_, std::int32_t{0}, partial, progress);
}

SolveReport DeviceSolve::solve(const LiquidParameters& p, const SolveParameters& solve,
                               const DeviceParticles& particles, int expected) {
  program_.run("end_iteration", Program::kGroup, solve, groups_, std::int32_t{1}, partial,
               progress);
  SolveProgress read;
  int batch = std::max(1, expected);
  do {
    // Iterations after the end of a solve have no effect.
    for (int n = 0; n < batch; ++n) iterate(p, solve, particles);
    read = read_progress();
    batch = kNextIterations;
  } while (read.is_open != 0);
  return {read.iterations, read.mean, read.greatest};
}

SolveReport DeviceSolve::measure_excess() {
  program_.run("measure_excess", Program::kGroup, count_, groups_, partial, progress);
  const SolveProgress read = read_progress();
  return {0, read.mean_excess, read.greatest_excess};
}

SolveProgress DeviceSolve::read_progress() {
  SolveProgress read{};
  program_.read(progress, std::span(&read, 1));
  return read;
}

}  // namespace vat
