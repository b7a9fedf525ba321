#pragma once

#include <cstdint>
#include <vector>

#include "core/device/common/kernel_values.h"
#include "core/device/opencl/program.h"
#include "core/guard/guard.h"
#include "core/model/model.h"
#include "core/state/state.h"
#include "core/stepping/control/step_control.h"

namespace vat {

/// The buffers of a change of motion, in the order of particles.
struct ProbedMotion {
  const opencl::Buffer& position_before;
  const opencl::Buffer& position;
  const opencl::Buffer& acceleration_before;
  const opencl::Buffer& acceleration;
  const opencl::Buffer& weight;
};

/// Returns the longest adaptive step [s] of a liquid in any state. It is at most the nominal step.
Real longest_adaptive_step(const Model& model);

/// A part of a nominal step: its times and its length [s].
struct StepPart {
  Real start, end, length;
};

/// Takes the nominal step from `start` to `end` [s] in parts. find_allowed_step(start) returns the
/// longest step from this time [s]. take_part(part) takes a step, updates history.observed_rate,
/// and returns whether the state is valid. Returns whether the state is valid after each part: an
/// invalid state could require very short parts.
template <class FindAllowedStep, class TakePart>
bool take_varied_step(const StepPart& nominal, StepHistory& history,
                      FindAllowedStep&& find_allowed_step, TakePart&& take_part) {
  for (Real left = nominal.length; left > 0;) {
    const Real start = nominal.start + (nominal.length - left);
    const std::uint32_t count =
        choose_step_count(find_allowed_step(start), left, nominal.length, history);
    const Real dt = history.step;
    if (!take_part(StepPart{start, count == 1 ? nominal.end : start + dt, dt})) return false;
    ++history.held;
    left = count == 1 ? 0 : left - dt;
  }
  return true;
}

/// Reductions for adaptive steps of liquids on a device. The functions throw opencl::DeviceFailure.
class DeviceStepControl {
 public:
  /// `partial` must have room for the sums of all groups of particles.
  DeviceStepControl(opencl::Program& program, const Model& model, const opencl::Buffer& partial);
  static std::size_t bytes_for(const Model& model);

  /// Returns the step that PresentSteps::least() would give for an incompressible liquid.
  Real least_step(const Model& model, const opencl::Buffer& velocity,
                  const opencl::Buffer& pressure);
  /// Returns the greatest speed that the last call of least_step() has found [m/s].
  Real greatest_speed() const { return greatest_speed_; }
  /// Returns the same step for a weakly compressible liquid. Unknown accelerations are 0.
  Real least_step_by_forces(const Model& model, const opencl::Buffer& velocity,
                            const opencl::Buffer& acceleration);
  /// Returns the rate that MotionProbe::observed_rate() would give.
  Real observed_rate(const Model& model, const ProbedMotion& motion);

 private:
  void select_pressure(const ModelBody& body, std::int32_t result, const opencl::Buffer& pressure);
  void find_mean_velocity(std::size_t particles, const opencl::Buffer& velocity);
  std::vector<Double4> read_results();

  opencl::Program& program_;
  const opencl::Buffer& partial_;
  const Real travel_;                ///< see GuardBounds [m]
  const Real own_step_;              ///< least of StepBounds [s]
  std::vector<std::size_t> bodies_;  ///< indices of the liquid bodies
  Real greatest_speed_ = 0;          ///< [m/s]
  opencl::Buffer motion_, results_, histogram_;
};

}  // namespace vat
