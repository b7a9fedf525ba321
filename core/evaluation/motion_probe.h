#pragma once

#include <vector>

#include "core/state/state.h"
#include "core/support/parallel.h"

namespace vat {

/// Sees the force evaluations of a step, and estimates from the first and the last of them how fast
/// the motion in it is: over each deformable or liquid body, in the norm of its masses and relative
/// to its mean, omega^2 = |change of acceleration| / |change of place|.
///
/// That is the error estimate that the methods embed, which costs no evaluation: Heun's step
/// differs from the embedded Euler step by dt/2 (a_2 - a_1), velocity Verlet misses dt^2/12 (a_2 -
/// a_1) of the path (the trapezoidal rule's error), and in Runge-Kutta 4 it is the quotient of
/// differences of stages that L. Collatz (The Numerical Treatment of Differential Equations, ch.
/// II) bounds. Over the path itself each is a function of omega dt alone; see
/// core/numerics/error_model.h.
class MotionProbe {
 public:
  /// A step begins; where the forces of its configuration are known already, the
  /// step does not evaluate them again.
  void begin(const State& state);
  void see(const Configuration& at, const Forces& forces);
  /// omega [rad/s]; 0 where there were fewer than two evaluations, or nothing moves.
  Real observed_rate(const Model& model) const;

 private:
  int seen_ = 0;
  std::vector<Vec3> first_position_;
  std::vector<Vec3> first_force_;
  std::vector<Vec3> last_position_;
  std::vector<Vec3> last_force_;
};

}  // namespace vat
