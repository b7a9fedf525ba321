#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "core/diagnostics.h"
#include "core/support/check.h"
#include "core/support/parallel.h"
#include "core/types.h"

namespace vat {

/// Stopping criteria of a Complementarity. Residuals are |excess| / scale of the unknowns whose
/// excess or x is above 0.
struct SolveLimits {
  Real mean = 0;
  Real greatest = 0;
  int most_iterations = 0;
  Real row = 0;  ///< upper bound of the row sums of |A| / diagonal
  /// Mean residual above which a solve makes at least one iteration.
  Real start = std::numeric_limits<Real>::infinity();
};

/// Finds x >= 0 with the excess e(x) = e(0) - A x <= 0, and e = 0 where x > 0, for a symmetric,
/// positive semi-definite A.
///
/// Uses conjugate gradients with the diagonal as preconditioner (E. Polak, G. Ribiere, Rev. Franc.
/// Inform. Rech. Oper. 16 (1969) 35) for the unknowns whose x or excess is above 0. After their
/// solution, negative x are set to 0. If the mean excess may then exceed its limit, it is computed
/// again and the search restarts (an active set that is updated as a whole, as by M. Hintermueller,
/// K. Ito, K. Kunisch, SIAM J. Optim. 13 (2003) 865). The result has the same bits for all numbers
/// of threads.
class Complementarity {
 public:
  std::vector<Real> x;
  std::vector<Real> excess;    ///< e(x), kept up to date
  std::vector<Real> diagonal;  ///< of A, or an upper bound; above 0
  std::vector<Real> scale;     ///< of the residuals; above 0

  void resize(std::size_t count);

  /// Solves from the present x >= 0 and its excess. `system.act(d)` and then
  /// `system.find_product(product)` compute product = A d. `system.add(share)` adds this share of
  /// the effect of d to the total effect, and `system.replace()` replaces the total effect by that
  /// of d. At the end no x is negative. The total effect is that of the change of x before negative
  /// x were set to 0; the mean includes the difference.
  template <class System>
  SolveReport solve(const SolveLimits& limits, TaskRunner* runner, System& system) {
    VAT_CHECK(excess.size() == x.size() && diagonal.size() == x.size() && scale.size() == x.size());
    SolveReport report;
    bool is_new = true;
    keep_start(runner);
    find_gradient(runner, report);
    const auto is_open = [&] {
      // A NaN ends the solve; the guard detects it.
      return !std::isnan(report.mean) &&
             (report.mean > limits.mean || report.greatest > limits.greatest);
    };
    const bool must_begin = report.mean > limits.start;
    // The last iteration closes the solve.
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
    Real square = 0;  ///< g.D g of the gradient g = D^-1 e for the x that may change
    Real mixed = 0;   ///< g.D g_last with the preceding gradient
  };

  void keep_start(TaskRunner* runner);
  void find_gradient(TaskRunner* runner, SolveReport& report) { take_step(0, runner, report); }
  /// Sets negative x to 0, and the direction to the change of x since the start. Returns the mean
  /// of these changes times diagonal / scale.
  Real clamp(TaskRunner* runner);
  /// Updates the excess at x by the product of the matrix and the change since the start, and the
  /// gradient and residuals there.
  void find_excess(TaskRunner* runner, SolveReport& report);
  /// d = g + beta d, or g if that is no descent direction. Returns the slope d.e.
  Real choose_direction(bool is_new, TaskRunner* runner);
  Real follow(Real share, TaskRunner* runner);
  /// The length to the minimum of x.A x / 2 - e(0).x along the direction.
  Real length_of_step(TaskRunner* runner, Real slope);
  /// Moves x by this length along the direction, and computes gradient and residuals.
  void take_step(Real length, TaskRunner* runner, SolveReport& report);
  template <class F>
  Real sum(TaskRunner* runner, F&& f);

  std::vector<Real> start_;         ///< x at the start
  std::vector<Real> start_excess_;  ///< its excess
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
