#pragma once

#include <cstdint>
#include <vector>

#include "core/device/opencl/program.h"
#include "core/guard/guard.h"
#include "core/model/model.h"

namespace vat {

/// Two results of a reduction.
struct Double2 {
  double x, y;
};

/// The buffers of a change of motion, in the order of particles.
struct ProbedMotion {
  const opencl::Buffer& position_before;
  const opencl::Buffer& position;
  const opencl::Buffer& acceleration_before;
  const opencl::Buffer& acceleration;
  const opencl::Buffer& weight;
};

/// Returns the longest adaptive step [s] of an incompressible liquid in any state. It is at most
/// the nominal step.
Real longest_adaptive_step(const Model& model);

/// Reductions for adaptive steps of incompressible liquids on a device. The functions throw
/// opencl::DeviceFailure.
class DeviceStepControl {
 public:
  /// `partial` must have room for the sums of all groups of particles.
  DeviceStepControl(opencl::Program& program, const Model& model, const opencl::Buffer& partial);
  static std::size_t bytes_for(const Model& model);

  /// Returns the step that PresentSteps::least() would give.
  Real least_step(const Model& model, const opencl::Buffer& velocity,
                  const opencl::Buffer& pressure);
  /// Returns the rate that MotionProbe::observed_rate() would give.
  Real observed_rate(const Model& model, const ProbedMotion& motion);

 private:
  void select_pressure(const ModelBody& body, std::int32_t result, const opencl::Buffer& pressure);
  std::vector<Double2> read_results();

  opencl::Program& program_;
  const opencl::Buffer& partial_;
  const Real travel_;                ///< see GuardBounds [m]
  const Real own_step_;              ///< least of StepBounds [s]
  std::vector<std::size_t> bodies_;  ///< indices of the liquid bodies
  opencl::Buffer motion_, results_, histogram_;
};

}  // namespace vat
