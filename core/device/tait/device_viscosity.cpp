#include "core/device/tait/device_viscosity.h"

#include <numeric>
#include <span>

#include "core/damping/damping_solve.h"
#include "core/device/common/kernel_values.h"
#include "core/device/solid/device_damping.h"

namespace vat {
namespace {

using opencl::Program;

constexpr std::size_t kColumn = 3 * sizeof(double);
constexpr std::size_t kColumns = 7;

/// The parameters of forces that depend on velocities linearly.
LiquidParameters only_with_damping(LiquidParameters p) {
  store(Vec3(Vec3::Zero()), p.gravity);
  store(Vec3(Vec3::Zero()), p.still);
  p.field_strength = 0;
  for (double& speed : p.speeds_of_walls) speed = 0;
  return p;
}

}  // namespace

DeviceViscosity::DeviceViscosity(Program& program, const Model& model)
    : program_(program),
      count_(model.liquid_count),
      mass_(program, count_ * sizeof(double)),
      mobility_(program, count_ * sizeof(double)),
      predicted_(program, count_ * kColumn),
      force_(program, count_ * kColumn),
      change_(program, count_ * kColumn),
      change_of_force_(program, count_ * kColumn),
      residual_(program, count_ * kColumn),
      direction_(program, count_ * kColumn),
      multiplied_(program, count_ * kColumn),
      sorted_direction_(program, slots_in_lanes(model.particle_count) * sizeof(Float4)),
      partial_(program, bytes_of_partial(model.particle_count)),
      momenta_(program, bytes_of_partial(count_)),
      progress_(program, sizeof(DampingProgress)) {
  const auto mass = std::span<const Real>(model.mass).first(count_);
  program.write(mass_, mass);
  program.write(mobility_, std::span<const Real>(model.inverse_mass).first(count_));
  total_mass_ = std::accumulate(mass.begin(), mass.end(), Real{0});
}

std::size_t DeviceViscosity::bytes_for(const Model& model) {
  return model.liquid_count * (2 * sizeof(double) + kColumns * kColumn) +
         slots_in_lanes(model.particle_count) * sizeof(Float4) +
         bytes_of_partial(model.particle_count) + bytes_of_partial(model.liquid_count) +
         sizeof(DampingProgress);
}

std::uint32_t DeviceViscosity::solve(const LiquidParameters& p, const DeviceParticles& s,
                                     const opencl::Buffer& velocity, Real dt,
                                     const opencl::Buffer& acceleration) {
  const DampingParameters damping = damping_parameters(dt, total_mass_, count_);
  const LiquidParameters linear = only_with_damping(p);
  const std::int32_t groups = groups_of(count_);
  constexpr std::size_t kOne = Program::kGroup;
  program_.run("begin_viscosity", s.count(), p, s.order, s.sorted_place, s.sorted_motion,
               acceleration, mass_, predicted_, force_);
  program_.run("begin_damping", count_, damping, mass_, mobility_, velocity, predicted_, force_,
               change_, change_of_force_, residual_, direction_, partial_, momenta_);
  program_.run("open_damping", kOne, damping, groups, partial_, momenta_, progress_);
  expected_ = run_iterations(program_, progress_, expected_, [&] {
    program_.run("turn_damping", count_, damping, progress_, mobility_, residual_, direction_);
    program_.run("sort_direction", s.count(), linear, progress_, s.order, s.sorted_place,
                 direction_, sorted_direction_);
    program_.run_in_lanes("multiply_viscosity", s.count(), linear, damping, progress_,
                          s.cells.begins, s.order, s.sorted_place, sorted_direction_,
                          s.neighbour_counts, s.plain_counts, s.neighbours, mass_, direction_,
                          multiplied_, partial_);
    program_.run("find_damping_length", kOne, groups_of(s.count()), partial_, progress_);
    program_.run("advance_damping", count_, damping, progress_, mass_, mobility_, velocity,
                 predicted_, direction_, multiplied_, change_, change_of_force_, residual_,
                 partial_);
    program_.run("end_damping_iteration", kOne, damping, groups, partial_, progress_);
  });
  program_.run("end_viscosity", count_, number_of(count_), mobility_, change_of_force_,
               acceleration);
  return static_cast<std::uint32_t>(expected_);
}

}  // namespace vat
