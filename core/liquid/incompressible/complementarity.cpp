#include "core/liquid/incompressible/complementarity.h"

#include <algorithm>
#include <cmath>

namespace vat {

void Complementarity::resize(std::size_t count) {
  for (std::vector<Real>* column :
       {&x, &excess, &diagonal, &scale, &gradient_, &direction_, &product_}) {
    column->resize(count);
  }
  partial_.resize(block_count(count));
  sums_.resize(block_count(count));
}

template <class F>
Real Complementarity::sum(TaskRunner* runner, F&& f) {
  for_blocks(runner, x.size(), [&](std::size_t begin, std::size_t end) {
    Real sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += f(i);
    partial_[begin / kBlockSize] = sum;
  });
  Real total = 0;
  for (const Real part : partial_) total += part;
  return total;
}

Real Complementarity::choose_direction(bool is_new, TaskRunner* runner) {
  if (is_new) longest_step_ = kLeastBound;
  const Real share =
      is_new || !(last_square_ > 0) ? 0 : std::max(Real{0}, (square_ - mixed_) / last_square_);
  const Real slope = follow(share, runner);
  return slope > 0 || share == 0 ? slope : follow(0, runner);
}

Real Complementarity::follow(Real share, TaskRunner* runner) {
  return sum(runner, [&](std::size_t i) {
    Real d = gradient_[i];
    if (share > 0) d += share * direction_[i];
    d = std::max(d, -x[i] / longest_step_);
    direction_[i] = d;
    return d * excess[i];
  });
}

Real Complementarity::length_of_step(Real slope, Real curvature) {
  const Real optimal = curvature > 0 ? slope / curvature : 0;
  const Real length = std::min(optimal, longest_step_);
  longest_step_ = std::clamp(kBoundOfOptimal * optimal, kLeastBound, kGreatestBound);
  return length;
}

void Complementarity::take_last_step(Real length, Real reduction, TaskRunner* runner,
                                     SolveReport& report) {
  for_blocks(runner, x.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      x[i] = std::max(Real{0}, x[i] + length * direction_[i]);  // below 0 by rounding only
    }
  });
  report.mean *= reduction;
  report.greatest *= reduction;
}

void Complementarity::take_step(Real length, TaskRunner* runner, SolveReport& report) {
  for_blocks(runner, x.size(), [&](std::size_t begin, std::size_t end) {
    Sums sums;
    for (std::size_t i = begin; i < end; ++i) {
      if (length > 0) {
        const Real next = x[i] + length * direction_[i];
        x[i] = next < 0 ? 0 : next;  // by rounding
        excess[i] -= length * product_[i];
      }
      const Real e = std::max(excess[i], -x[i] * diagonal[i]);
      const Real residual = std::abs(e) / scale[i];
      sums.residual += residual;
      // Without this part, the pressure between particles that separate would accelerate them as
      // long as other particles need no iteration.
      const bool pushes = x[i] * diagonal[i] > negligible_ * scale[i];
      sums.greatest = std::max(sums.greatest, pushes ? std::abs(excess[i]) / scale[i] : residual);
      sums.mixed += e * gradient_[i];
      gradient_[i] = e / diagonal[i];
      sums.square += e * gradient_[i];
    }
    sums_[begin / kBlockSize] = sums;
  });
  Sums total;
  for (const Sums& part : sums_) {
    total.residual += part.residual;
    total.greatest = std::max(total.greatest, part.greatest);
    total.square += part.square;
    total.mixed += part.mixed;
  }
  report.mean = x.empty() ? 0 : total.residual / static_cast<Real>(x.size());
  report.greatest = total.greatest;
  last_square_ = square_;
  square_ = total.square;
  mixed_ = total.mixed;
}

}  // namespace vat
