#include "core/device/incompressible/device_solve.h"

#include <algorithm>

#include "core/device/contact/solid_geometry.h"
#include "core/device/incompressible/device_pushes.h"
#include "core/liquid/incompressible/solve_limits.h"
#include "core/liquid/pairs/coupled_pairs.h"
#include "core/support/check.h"

namespace vat {
namespace {

using opencl::Program;

constexpr int kNextIterations = 4;  // in further batches, if a solve needs more than expected

std::size_t bytes_of_sums(const Model& model) {
  const std::size_t bodies = solids_move(model) ? model.rigid_bodies.size() : 0;
  return bytes_of_partial(model.particle_count) + bodies * sizeof(Double4);
}

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
  p.push_factor = -2 * slope_factor(model, liquid) * p.volume;
  p.slope_scale = liquid.slope_scale;
  p.count = static_cast<std::int32_t>(model.liquid_count);
  p.slots = static_cast<std::int32_t>(model.particle_count);
  p.free = static_cast<std::int32_t>(SolidRange(model).free);
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
      partial(program, bytes_of_sums(model)),
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
         slots_in_lanes(n) * 2 * sizeof(Float4) + bytes_of_sums(model) + sizeof(SolveProgress);
}

void DeviceSolve::accelerate(const LiquidParameters& p, const SolveParameters& solve,
                             const DeviceParticles& s, DevicePushes* pushes) {
  // Without moving solids, the kernel does not use their buffers.
  const opencl::Buffer& mobility = pushes != nullptr ? pushes->mobility() : product_;
  const opencl::Buffer& push = pushes != nullptr ? pushes->push() : product_;
  program_.run_in_lanes("accelerate", slots_, p, solve, progress, s.cells.begins, s.order,
                        s.sorted_place, s.neighbour_counts, s.plain_counts, s.neighbours, charge_,
                        mobility, push, solve_motion, partial);
  std::int32_t sums = groups_;
  if (pushes != nullptr) {
    pushes->accelerate_bodies(solve, s, groups_, progress, solve_motion, partial);
    sums += pushes->bodies();
  }
  program_.run("find_length", Program::kGroup, solve, sums, partial, progress);
}

void DeviceSolve::iterate(const LiquidParameters& p, const SolveParameters& solve,
                          const DeviceParticles& s, DevicePushes* pushes) {
  constexpr std::size_t kOne = Program::kGroup;
  for (const std::int32_t is_restart : {0, 1}) {
    program_.run("follow", slots_, solve.slots, is_restart, progress, x, excess, gradient,
                 direction_, charge_, partial);
    program_.run("find_slope", kOne, groups_, is_restart, partial, progress);
  }
  accelerate(p, solve, s, pushes);
  if (pushes != nullptr) pushes->add(solve, progress);
  program_.run_in_lanes("compress", slots_, p, solve, progress, s.cells.begins, s.sorted_place,
                        s.neighbour_counts, s.plain_counts, s.neighbours, solve_motion, product_);
  program_.run("take_step", slots_, solve, progress, s.sorted_place, squares, direction_, product_,
               solve_motion, x, excess, gradient, whole, partial);
  program_.run("end_iteration", kOne, solve, groups_, std::int32_t{0}, partial, progress);
}

SolveReport DeviceSolve::solve(const LiquidParameters& p, const SolveParameters& solve,
                               const DeviceParticles& particles, DevicePushes* pushes,
                               int expected) {
  VAT_CHECK((pushes != nullptr) == (solve.solids_move != 0));
  if (pushes != nullptr) pushes->begin();
  program_.run("end_iteration", Program::kGroup, solve, groups_, std::int32_t{1}, partial,
               progress);
  SolveProgress read;
  int batch = std::max(1, expected);
  do {
    // Iterations after the end of a solve have no effect.
    for (int n = 0; n < batch; ++n) iterate(p, solve, particles, pushes);
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
