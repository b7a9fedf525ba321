#pragma once

#include <vector>

#include "core/state/state.h"
#include "core/support/parallel.h"

namespace vat {

/// Estimates the angular frequency omega of the motion in a step from the first and the last force
/// evaluation. For each deformable or liquid body, omega^2 = |change of acceleration| / |change of
/// position|. Both norms are weighted by mass and relative to the mean of the body.
///
/// The estimate is the error estimate embedded in the integrators, without further evaluations.
/// Heun's step differs from the embedded Euler step by dt/2 (a_2 - a_1). The position error of
/// velocity Verlet is dt^2/12 (a_2 - a_1), the same as that of the trapezoidal rule. For
/// Runge-Kutta 4, the estimate is the quotient of stage differences that L. Collatz bounds (The
/// Numerical Treatment of Differential Equations, ch. II). Each error divided by the distance moved
/// is a function of omega dt only; see core/numerics/error_model.h.
class MotionProbe {
 public:
  /// Begins a step. Records the forces of the state if they are current, because the step does not
  /// evaluate these forces again.
  void begin(const State& state);
  void see(const Configuration& at, const Forces& forces);
  /// Returns the maximum omega of all bodies [rad/s]. Returns 0 after fewer than two evaluations,
  /// or without motion.
  Real observed_rate(const Model& model) const;

 private:
  int seen_ = 0;
  std::vector<Vec3> first_position_;
  std::vector<Vec3> first_force_;
  std::vector<Vec3> last_position_;
  std::vector<Vec3> last_force_;
};

/// Returns omega of one body [rad/s]. Both sums are over its particles, relative to the mean of the
/// body: `way2` is the sum of m |change of position|^2 [kg m^2], and `change2` is the sum of
/// m |change of acceleration|^2 [kg m^2/s^4]. `radius` is the radius of a particle [m], and `mass`
/// is the mass of the body [kg]. Returns 0 if `way2` is as small as rounding errors.
Real rate_of_motion(Real way2, Real change2, Real radius, Real mass);

}  // namespace vat
