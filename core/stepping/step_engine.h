#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "core/guard/guard.h"
#include "core/model/model.h"
#include "core/stage/advance_report.h"
#include "core/state/controls.h"
#include "core/state/state.h"
#include "core/support/result.h"

namespace vat {

/// The arguments of StepEngine::advance().
struct EngineInput {
  const Controls& controls;
  const State& state;  ///< of the last reading, except for step_count
  AdvanceReport& report;
  bool continues;  ///< the device has the present state; otherwise, `state` has it
};

/// Motion of the particles of a body.
struct ParticleMotion {
  Real speed = 0;            ///< maximum speed [m/s]
  Vec3 low = Vec3::Zero();   ///< minimum of the positions [m]
  Vec3 high = Vec3::Zero();  ///< maximum of the positions [m]
};

/// Motion of the bodies of a model.
struct BodyMotions {
  std::vector<RigidState> rigid;          ///< by rigid body
  std::vector<ParticleMotion> particles;  ///< by body; unspecified for rigid and empty bodies
};

/// Takes nominal steps of a simulation on a device, in place of the Stepper. The results are those
/// of the Stepper up to rounding.
class StepEngine {
 public:
  virtual ~StepEngine() = default;

  /// Returns a name of the arithmetic of the results, such as "opencl-exact".
  virtual std::string_view arithmetic() const = 0;

  /// Prepares the engine for the steps of a model. `bounds` are the bounds of its valid states;
  /// they also depend on sleeping bodies, which are not in the model. Fails if the device lacks a
  /// feature of the scene, with the path of this feature in the scene and the code "not_on_device".
  /// Fails if the device has not enough memory, with the code "device_failed".
  virtual Status bind(std::shared_ptr<const Model> model, const GuardBounds& bounds) = 0;

  /// Takes `steps` > 0 nominal steps of the bound model. Returns false if the device cannot take
  /// them: a step fails (see GuardEvent), a held body is released, or users exert forces on bodies.
  /// The device then has the
  /// state before the call. Fails with the code "device_failed" if the device is lost.
  virtual Result<bool> advance(const EngineInput& input, std::uint32_t steps) = 0;

  /// Reads the positions, velocities and forces of `state` from the device. Fails with the code
  /// "device_failed" and an unchanged state if the device is lost.
  virtual Status read(State& state) = 0;

  /// Reads the motion of all bodies from the device, which must have the present state. Only scenes
  /// with sleeping need it. Fails with the code "device_failed" if the device is lost.
  virtual Status read_motions(BodyMotions& motions) = 0;
};

}  // namespace vat
