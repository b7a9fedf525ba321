#pragma once

#include <vector>

#include "core/state/state.h"
#include "core/support/parallel.h"

namespace vat {

/// Estimates the rate of motion in a step from the first and the last force evaluation: for each
/// deformable or liquid body, in the norm of its masses and relative to its mean, omega^2 = |change
/// of acceleration| / |change of position|.
///
/// This is the error estimate embedded in the methods, without further evaluations. Heun's step
/// differs from the embedded Euler step by dt/2 (a_2 - a_1). The position error of velocity Verlet
/// is dt^2/12 (a_2 - a_1), that of the trapezoidal rule. In Runge-Kutta 4 it is the quotient of
/// stage differences that L. Collatz (The Numerical Treatment of Differential Equations, ch. II)
/// bounds. Divided by the path, each is a function of omega dt only; see
/// core/numerics/error_model.h.
class MotionProbe {
 public:
  /// Begins a step. Includes the forces of the state if they are current, because the step does not
  /// evaluate them again.
  void begin(const State& state);
  void see(const Configuration& at, const Forces& forces);
  /// omega [rad/s]; 0 after fewer than two evaluations, or without motion.
  Real observed_rate(const Model& model) const;

 private:
  int seen_ = 0;
  std::vector<Vec3> first_position_;
  std::vector<Vec3> first_force_;
  std::vector<Vec3> last_position_;
  std::vector<Vec3> last_force_;
};

}  // namespace vat
