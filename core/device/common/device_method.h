#pragma once

#include "core/stepping/step_engine.h"
#include "core/support/check.h"

namespace vat {

/// The steps of one liquid solver on a device, for one model. The functions throw
/// opencl::DeviceFailure.
class DeviceMethod {
 public:
  virtual ~DeviceMethod() = default;

  /// Takes steps as StepEngine::advance(), without grabs and applied forces.
  virtual bool take_steps(const EngineInput& input, std::uint32_t steps) = 0;
  /// Reads the state as StepEngine::read(). If an exception is thrown, `state` is unchanged.
  virtual void read(State& state) = 0;
  /// Reads the motion of bodies as StepEngine::read_motions(). Methods whose scenes can have
  /// sleeping implement it.
  virtual void read_motions(BodyMotions&) { VAT_CHECK(false); }
};

}  // namespace vat
