#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "core/diagnostics.h"
#include "core/support/check.h"
#include "core/support/parallel.h"
#include "core/types.h"

namespace vat {

/// Stopping criteria of a Complementarity. The residual of an unknown is |min(diagonal x, -excess)|
/// / scale, which is 0 if and only if the conditions of the unknown hold. For the greatest
/// residual, it is |excess| / scale if diagonal x / scale exceeds a tenth of the limit of the mean.
struct SolveLimits {
  Real mean = 0;
  Real greatest = 0;
  int most_iterations = 0;
  /// Initial mean and greatest residual above which a solve makes at least one iteration.
  Real start_mean = std::numeric_limits<Real>::infinity();
  Real start_greatest = std::numeric_limits<Real>::infinity();
  /// Expected ratios of the residuals after and before the first iteration and a later one. If the
  /// expected residuals are within the limits, the iteration is the last. Its residuals are not
  /// computed. With the default, all residuals are computed.
  Real first_reduction = std::numeric_limits<Real>::infinity();
  Real later_reduction = std::numeric_limits<Real>::infinity();
};

/// A linear complementarity problem with a symmetric, positive semi-definite matrix A: find x >= 0
/// with the excess e(x) = e(0) - A x <= 0, and e_i = 0 if x_i > 0.
///
/// The method is the conjugate gradient method with the diagonal as preconditioner (E. Polak, G.
/// Ribiere, Rev. Franc. Inform. Rech. Oper. 16 (1969) 35). The gradient is projected onto x >= 0,
/// and each direction is shortened for the unknowns close to 0, so that no step makes x negative
/// (as in Z. Dostal, J. Schoeberl, Comput. Optim. Appl. 30 (2005) 23). The result is bitwise
/// independent of the number of threads.
class Complementarity {
 public:
  // Bounds of longest_step_. Optimal steps of the solves of liquids are 0.5 to 2.3 long, and longer
  // in solves with small tolerances. Unknowns approach 0 by the ratio of the step and its bound.
  static constexpr Real kLeastBound = 1.25;
  static constexpr Real kGreatestBound = 8;
  static constexpr Real kBoundOfOptimal = 1.25;  ///< bound / optimal length of the last step
  /// Share of the limit of the mean residual below which diagonal x / scale counts as 0.
  static constexpr Real kNegligible = 0.1;

  std::vector<Real> x;
  std::vector<Real> excess;    ///< e(x); outdated after an iteration without computed residuals
  std::vector<Real> diagonal;  ///< diagonal of A, or an upper bound; above 0
  std::vector<Real> scale;     ///< scale of the residuals; above 0

  void resize(std::size_t count);

  /// Solves the problem, starting from the present `x` >= 0 and its `excess`. `system.act(d)` must
  /// return d.A d. A following `system.find_product(product)` must compute product = A d.
  /// `system.add(share)` must add `share` times the effect of d to the total effect. The final x is
  /// not negative, and the total effect is that of the change of x.
  template <class System>
  SolveReport solve(const SolveLimits& limits, TaskRunner* runner, System& system) {
    VAT_CHECK(excess.size() == x.size() && diagonal.size() == x.size() && scale.size() == x.size());
    SolveReport report;
    negligible_ = kNegligible * limits.mean;
    find_gradient(runner, report);
    const auto is_open = [&] {
      // A NaN ends the solve; the guard (core/guard/guard.h) detects the NaN.
      return !std::isnan(report.mean) &&
             (report.mean > limits.mean || report.greatest > limits.greatest);
    };
    const bool must_begin =
        report.mean > limits.start_mean || report.greatest > limits.start_greatest;
    while ((is_open() || (must_begin && report.iterations == 0)) &&
           report.iterations < limits.most_iterations) {
      const Real slope = choose_direction(report.iterations == 0, runner);
      const Real length = length_of_step(slope, system.act(direction_));
      system.add(length);
      const Real reduction =
          report.iterations == 0 ? limits.first_reduction : limits.later_reduction;
      ++report.iterations;
      if (report.mean * reduction <= limits.mean &&
          report.greatest * reduction <= limits.greatest) {
        take_last_step(length, reduction, runner, report);
        break;
      }
      system.find_product(product_);
      take_step(length, runner, report);
    }
    return report;
  }

 private:
  /// Sums and maxima over one block.
  struct Sums {
    Real residual = 0;
    Real greatest = 0;
    Real square = 0;  ///< g.D g of the projected gradient g = max(D^-1 e, -x)
    Real mixed = 0;   ///< g.D g_last, with the preceding gradient g_last
  };

  void find_gradient(TaskRunner* runner, SolveReport& report) { take_step(0, runner, report); }
  /// Sets the direction d to g + beta d, or to g if g + beta d is not a descent direction. Shortens
  /// d so that x + longest_step_ d >= 0. Returns the slope d.e.
  Real choose_direction(bool is_new, TaskRunner* runner);
  Real follow(Real share, TaskRunner* runner);
  /// Returns the step length to the minimum of x.A x / 2 - e(0).x along the direction, at most
  /// longest_step_, and sets longest_step_ for the next iteration.
  Real length_of_step(Real slope, Real curvature);
  /// Moves x by `length` times the direction, and computes the gradient and the residuals.
  void take_step(Real length, TaskRunner* runner, SolveReport& report);
  /// Moves x by `length` times the direction. Sets the residuals to the expected values.
  void take_last_step(Real length, Real reduction, TaskRunner* runner, SolveReport& report);
  template <class F>
  Real sum(TaskRunner* runner, F&& f);

  std::vector<Real> gradient_;
  std::vector<Real> direction_;
  std::vector<Real> product_;
  std::vector<Real> partial_;  ///< by block
  std::vector<Sums> sums_;     ///< by block
  Real longest_step_ = 0;      ///< upper bound of the length of a step
  Real negligible_ = 0;        ///< x counts as 0 if x diagonal / scale is at most this
  Real square_ = 0;
  Real mixed_ = 0;
  Real last_square_ = 0;
};

}  // namespace vat
