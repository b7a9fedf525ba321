#pragma once

#include <cmath>
#include <vector>

#include "core/diagnostics.h"
#include "core/support/parallel.h"
#include "core/types.h"

namespace vat {

/// Until when a Complementarity is solved. Residuals are |excess| over the unknown's scale, of
/// those excesses that are above 0, or whose x is.
struct SolveLimits {
  Real mean = 0;
  Real greatest = 0;
  int most_iterations = 0;
  Real row = 0;  ///< of A: the sum of magnitudes over the diagonal, at most
};

/// Find x >= 0 whose excess e(x) = e(0) - A x is nowhere above 0, and 0 where x > 0, with A
/// symmetric and positive semi-definite.
///
/// By conjugate gradients with the diagonal as preconditioner (E. Polak, G. Ribiere, Rev. Franc.
/// Inform. Rech. Oper. 16 (1969) 35) for the x that are above 0 or whose excess is; once these are
/// solved, x below 0 become 0, and where the mean excess may then be too much it is found anew, and
/// the search begins anew (an active set that is corrected as a whole, as by M. Hintermueller, K.
/// Ito, K. Kunisch, SIAM J. Optim. 13 (2003) 865). The same bits for any number of threads.
class Complementarity {
 public:
  std::vector<Real> x;
  std::vector<Real> excess;    ///< e(x), kept up to date
  std::vector<Real> diagonal;  ///< of A, or a bound of it; above 0
  std::vector<Real> scale;     ///< of the residuals; above 0

  void resize(std::size_t count);

  /// From the present x >= 0 and its excess. `system.act(d)` and then
  /// `system.find_product(product)` set product = A d; `system.add(share)` adds that share of what
  /// d did to what all of them have done, and `system.replace()` makes what d did all. At the end
  /// no x is below 0; what was done is that of x before those were set to 0, less x at the start,
  /// and the mean allows for it.
  template <class System>
  SolveReport solve(const SolveLimits& limits, TaskRunner* runner, System& system) {
    SolveReport report;
    bool is_new = true;
    keep_start(runner);
    find_gradient(runner, report);
    const auto is_open = [&] {
      // A NaN ends it, and is the guard's to see.
      return !std::isnan(report.mean) &&
             (report.mean > limits.mean || report.greatest > limits.greatest);
    };
    // The last one is to close the solve.
    while (is_open() && report.iterations + 2 <= limits.most_iterations) {
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
  /// Sums and greatest values over one block.
  struct Sums {
    Real residual = 0;
    Real greatest = 0;
    Real square = 0;  ///< g.D g of the gradient g = D^-1 e where x may change
    Real mixed = 0;   ///< the same with that before
  };

  void keep_start(TaskRunner* runner);
  void find_gradient(TaskRunner* runner, SolveReport& report) { take_step(0, runner, report); }
  /// Sets x below 0 to 0, and the direction to the way from the start to x. The mean of their
  /// changes times the diagonal over the scale.
  Real clamp(TaskRunner* runner);
  /// Of x, by the product of the way from the start; and gradient and residuals there.
  void find_excess(TaskRunner* runner, SolveReport& report);
  /// d = g + beta d, or g where that does not lead down; the slope d.e.
  Real choose_direction(bool is_new, TaskRunner* runner);
  Real follow(Real share, TaskRunner* runner);
  /// To the least x.A x / 2 - e(0).x along the direction.
  Real length_of_step(TaskRunner* runner, Real slope);
  /// Goes so far along the direction, and finds gradient and residuals there.
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
