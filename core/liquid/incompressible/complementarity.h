#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "core/diagnostics.h"
#include "core/support/check.h"
#include "core/support/parallel.h"
#include "core/types.h"

namespace vat {

/// Stopping criteria of a Complementarity. The residual of an unknown with x > 0 or excess > 0 is
/// |excess| / scale; other residuals are 0.
struct SolveLimits {
  Real mean = 0;
  Real greatest = 0;
  int most_iterations = 0;
  Real row = 0;  ///< upper bound of the row sums of |A| / diagonal
  /// Initial mean residual above which a solve makes at least one iteration.
  Real start = std::numeric_limits<Real>::infinity();
};

/// A linear complementarity problem with a symmetric, positive semi-definite matrix A: find x >= 0
/// with the excess e(x) = e(0) - A x <= 0, and e_i = 0 if x_i > 0.
///
/// The method is the conjugate gradient method with the diagonal as preconditioner (E. Polak, G.
/// Ribiere, Rev. Franc. Inform. Rech. Oper. 16 (1969) 35), for the unknowns with x > 0 or excess >
/// 0. After convergence, negative x are set to 0. If the mean residual may then exceed its limit,
/// the excess is recomputed and the iteration restarts. The active set is thus updated as a whole,
/// as in M. Hintermueller, K. Ito, K. Kunisch, SIAM J. Optim. 13 (2003) 865. The result is bitwise
/// independent of the number of threads.
class Complementarity {
 public:
  std::vector<Real> x;
  std::vector<Real> excess;    ///< e(x)
  std::vector<Real> diagonal;  ///< diagonal of A, or an upper bound; above 0
  std::vector<Real> scale;     ///< scale of the residuals; above 0

  void resize(std::size_t count);

  /// Solves the problem, starting from the present `x` >= 0 and its `excess`. `system.act(d)`
  /// followed by `system.find_product(product)` must compute product = A d. `system.add(share)`
  /// must add `share` times the effect of d to the total effect. `system.replace()` must replace
  /// the total effect by the effect of d. The final x is not negative. The final total effect does
  /// not include the last change of negative x to 0. The reported mean residual
  /// includes the effect of this change.
  template <class System>
  SolveReport solve(const SolveLimits& limits, TaskRunner* runner, System& system) {
    VAT_CHECK(excess.size() == x.size() && diagonal.size() == x.size() && scale.size() == x.size());
    SolveReport report;
    bool is_new = true;
    keep_start(runner);
    find_gradient(runner, report);
    const auto is_open = [&] {
      // A NaN ends the solve; the guard (core/guard/guard.h) detects the NaN.
      return !std::isnan(report.mean) &&
             (report.mean > limits.mean || report.greatest > limits.greatest);
    };
    const bool must_begin = report.mean > limits.start;
    // The last of the allowed iterations is reserved for recomputing the excess.
    while ((is_open() || (must_begin && report.iterations == 0)) &&
           report.iterations + 2 <= limits.most_iterations) {
      const Real slope = choose_direction(is_new, runner);
      system.act(direction_);
      system.find_product(product_);
      ++report.iterations;
      const Real length = length_of_step(runner, slope);
      system.add(length);
      take_step(length, runner, report);
      is_new = !is_open() || report.iterations + 2 > limits.most_iterations;
      if (!is_new) continue;
      const Real change = limits.row * clamp(runner);
      if (report.mean + change <= limits.mean) {
        report.mean += change;
        break;
      }
      system.act(direction_);
      system.find_product(product_);
      system.replace();
      ++report.iterations;
      find_excess(runner, report);
    }
    return report;
  }

 private:
  /// Sums and maxima over one block.
  struct Sums {
    Real residual = 0;
    Real greatest = 0;
    Real square = 0;  ///< g.D g of the gradient g = D^-1 e over the active unknowns
    Real mixed = 0;   ///< g.D g_last, with the preceding gradient g_last
  };

  void keep_start(TaskRunner* runner);
  void find_gradient(TaskRunner* runner, SolveReport& report) { take_step(0, runner, report); }
  /// Sets negative x to 0. Then sets direction_ to the change of x since the start of the solve.
  /// Returns the mean over all unknowns of the negative part of x times diagonal / scale.
  Real clamp(TaskRunner* runner);
  /// Computes the excess at x from the product of A and the change of x since the start, and then
  /// the gradient and the residuals.
  void find_excess(TaskRunner* runner, SolveReport& report);
  /// Sets the direction d to g + beta d, or to g if g + beta d is not a descent direction. Returns
  /// the slope d.e.
  Real choose_direction(bool is_new, TaskRunner* runner);
  Real follow(Real share, TaskRunner* runner);
  /// Returns the step length to the minimum of x.A x / 2 - e(0).x along the direction.
  Real length_of_step(TaskRunner* runner, Real slope);
  /// Moves x by `length` times the direction, and computes the gradient and the residuals.
  void take_step(Real length, TaskRunner* runner, SolveReport& report);
  template <class F>
  Real sum(TaskRunner* runner, F&& f);

  std::vector<Real> start_;         ///< x at the start
  std::vector<Real> start_excess_;  ///< excess at the start
  std::vector<Real> gradient_;
  std::vector<Real> direction_;
  std::vector<Real> product_;
  std::vector<Real> partial_;  ///< by block
  std::vector<Sums> sums_;     ///< by block
  Real square_ = 0;
  Real mixed_ = 0;
  Real last_square_ = 0;
};

}  // namespace vat
