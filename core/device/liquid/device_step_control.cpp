#include "core/device/liquid/device_step_control.h"

#include <algorithm>
#include <cmath>

#include "core/device/common/kernel_values.h"
#include "core/evaluation/motion_probe.h"
#include "core/limits.h"
#include "core/stepping/control/step_control.h"
#include "core/stepping/control/step_control_liquid.h"

namespace vat {
namespace {

using opencl::Buffer;
using opencl::Program;

constexpr std::size_t kMotionBytes = 32;  // the struct Motion of step_control.cl
constexpr std::size_t kDigits = 256;
constexpr int kDigitBits = 8;
constexpr int kKeyBits = 32;

std::int32_t first_of(const ModelBody& body) {
  return static_cast<std::int32_t>(body.particles.begin);
}
std::int32_t count_of(const ModelBody& body) {
  return static_cast<std::int32_t>(body.particles.size());
}

/// The least step of StepBounds [s].
Real find_own_step(const Model& model) {
  const StepBounds bounds = find_step_bounds(model);
  return std::min(bounds.scene_step, std::ranges::min(bounds.own_step));
}

}  // namespace

Real longest_adaptive_step(const Model& model) {
  const Numerics& numerics = model.scene.numerics;
  const Real step = without_viscosity_solve(model, std::min(find_own_step(model), numerics.step));
  return std::max(step, std::ldexp(numerics.step, -kMaxStepLevel));
}

DeviceStepControl::DeviceStepControl(Program& program, const Model& model, const Buffer& partial)
    : program_(program),
      partial_(partial),
      travel_(guard_bounds(model).travel[model.body[0]]),
      own_step_(find_own_step(model)),
      motion_(program, kMotionBytes),
      results_(program, (model.bodies.size() + 1) * sizeof(Double4)),
      histogram_(program, kDigits * sizeof(std::int32_t)) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    if (body.kind == BodyKind::liquid && body.particles.size() > 0) bodies_.push_back(b);
  }
}

std::size_t DeviceStepControl::bytes_for(const Model& model) {
  return kMotionBytes + (model.bodies.size() + 1) * sizeof(Double4) +
         kDigits * sizeof(std::int32_t);
}

void DeviceStepControl::select_pressure(const ModelBody& body, std::int32_t result,
                                        const Buffer& pressure) {
  const std::size_t n = body.particles.size();
  const auto rank = static_cast<std::int32_t>(lasting_rank(n));
  program_.run("begin_selection", Program::kGroup, groups_of(n), rank, result, partial_, motion_,
               results_, histogram_);
  for (std::int32_t shift = kKeyBits - kDigitBits; shift >= 0; shift -= kDigitBits) {
    program_.run("count_digits", n, first_of(body), count_of(body), shift, pressure, motion_,
                 histogram_);
    program_.run("select_digit", Program::kGroup, shift, result, histogram_, motion_, results_);
  }
}

void DeviceStepControl::find_mean_velocity(std::size_t particles, const Buffer& velocity) {
  const auto count = static_cast<std::int32_t>(particles);
  const auto last = static_cast<std::int32_t>(bodies_.size());
  program_.run("sum_velocities", particles, count, velocity, partial_);
  program_.run("find_mean", Program::kGroup, count, groups_of(particles), last, partial_, motion_,
               results_);
}

Real DeviceStepControl::least_step(const Model& model, const Buffer& velocity,
                                   const Buffer& pressure) {
  find_mean_velocity(model.liquid_count, velocity);
  std::int32_t result = 0;
  for (const std::size_t b : bodies_) {
    const ModelBody& body = model.bodies[b];
    program_.run("find_relative_speeds", body.particles.size(), first_of(body), count_of(body),
                 velocity, motion_, partial_);
    select_pressure(body, result++, pressure);
  }
  const std::vector<Double4> results = read_results();
  greatest_speed_ = std::sqrt(results.back().x);
  Real step = step_of_particles(own_step_, travel_, greatest_speed_);
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const LiquidMotion motion{std::sqrt(results[k].x), 0, results[k].y};
    step = std::min(step, step_of_liquid(model, bodies_[k], motion));
  }
  return step;
}

Real DeviceStepControl::least_step_by_forces(const Model& model, const Buffer& velocity,
                                             const Buffer& acceleration) {
  find_mean_velocity(model.liquid_count, velocity);
  const Real way = kTravelShare * travel_;
  std::int32_t result = 0;
  for (const std::size_t b : bodies_) {
    const ModelBody& body = model.bodies[b];
    const std::size_t n = body.particles.size();
    program_.run("find_greatest_motion", n, first_of(body), count_of(body), 4 * way, velocity,
                 acceleration, motion_, partial_);
    program_.run("end_greatest_motion", Program::kGroup, groups_of(n), result++, partial_,
                 results_);
  }
  const std::vector<Double4> results = read_results();
  Real step = own_step_;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const Double4& greatest = results[k];
    const LiquidMotion motion{std::sqrt(greatest.x), std::sqrt(greatest.y), 0};
    step = std::min({step, 2 * way / greatest.z, step_of_liquid(model, bodies_[k], motion)});
  }
  return step;
}

Real DeviceStepControl::observed_rate(const Model& model, const ProbedMotion& motion) {
  const LiquidModel& liquid = *model.liquids[model.material[0]];
  const Real mass_of_weight = liquid.rest_density / liquid.kernel.scale();
  std::int32_t result = 0;
  for (const std::size_t b : bodies_) {
    const ModelBody& body = model.bodies[b];
    const std::size_t n = body.particles.size();
    const Real scale = mass_of_weight / body.mass;
    for (const std::int32_t is_force : {0, 1}) {
      for (const std::int32_t is_square : {0, 1}) {
        program_.run("sum_changes", n, first_of(body), count_of(body), is_force, is_square,
                     motion.position_before, motion.position, motion.acceleration_before,
                     motion.acceleration, motion.weight, motion_, partial_);
        program_.run("end_changes", Program::kGroup, groups_of(n), scale, is_force, is_square,
                     result, partial_, motion_, results_);
      }
    }
    ++result;
  }
  const std::vector<Double4> results = read_results();
  Real greatest = 0;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const ModelBody& body = model.bodies[bodies_[k]];
    const Real radius = model.radius[body.particles.begin];
    greatest = std::max(greatest, rate_of_motion(results[k].x * body.mass, results[k].y * body.mass,
                                                 radius, body.mass));
  }
  return greatest;
}

std::vector<Double4> DeviceStepControl::read_results() {
  std::vector<Double4> results(bodies_.size() + 1);
  program_.read(results_, std::span(results));
  return results;
}

}  // namespace vat
