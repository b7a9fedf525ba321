#pragma once

#include <chrono>
#include <mutex>
#include <optional>

#include "core/scene/scene.h"
#include "core/support/instruction_set.h"
#include "core/support/parallel.h"

namespace vat {

/// Speed of this machine, measured by a short run of a liquid on all threads of a runner.
class MachineSpeed {
 public:
  /// Returns the expected simulated seconds per second of a valid scene: the inverse of its cost
  /// estimate, corrected by the measured speed. The first call measures, which takes about
  /// kMeasuringTime. Thread-safe.
  Real real_time_factor(const Scene& scene, TaskRunner* runner, InstructionSet instructions);

  static constexpr std::chrono::milliseconds kMeasuringTime{200};

 private:
  std::mutex mutex_;
  std::optional<Real> measured_;  ///< measured / estimated cost, after the first call
};

}  // namespace vat
