#include "core/liquid/incompressible/complementarity.h"

#include <algorithm>
#include <cmath>

#include "core/support/check.h"

namespace vat {

void Complementarity::resize(std::size_t count) {
  for (std::vector<Real>* column : {&x, &excess, &diagonal, &scale, &start_, &start_excess_,
                                    &gradient_, &direction_, &product_}) {
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

void Complementarity::keep_start(TaskRunner* runner) {
  for_blocks(runner, x.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      start_[i] = x[i];
      start_excess_[i] = excess[i];
    }
  });
}

Real Complementarity::clamp(TaskRunner* runner) {
  const Real undone = sum(runner, [&](std::size_t i) {
    const Real change = x[i] < 0 ? -x[i] : 0;
    x[i] += change;
    direction_[i] = x[i] - start_[i];
    return change * diagonal[i] / scale[i];
  });
  return undone / static_cast<Real>(x.size());
}

void Complementarity::find_excess(TaskRunner* runner, SolveReport& report) {
  for_blocks(runner, x.size(), [&](std::size_t begin, std::size_t end) {
    VAT_CHECK(start_excess_.size() == x.size() && product_.size() == x.size());
    for (std::size_t i = begin; i < end; ++i) excess[i] = start_excess_[i] - product_[i];
  });
  find_gradient(runner, report);
}

Real Complementarity::choose_direction(bool is_new, TaskRunner* runner) {
  const Real share =
      is_new || !(last_square_ > 0) ? 0 : std::max(Real{0}, (square_ - mixed_) / last_square_);
  const Real slope = follow(share, runner);
  return slope > 0 || share == 0 ? slope : follow(0, runner);
}

Real Complementarity::follow(Real share, TaskRunner* runner) {
  return sum(runner, [&](std::size_t i) {
    Real d = gradient_[i];
    if (share > 0) d += share * direction_[i];
    if (d < 0 && !(x[i] > 0)) d = 0;
    direction_[i] = d;
    return d * excess[i];
  });
}

Real Complementarity::length_of_step(TaskRunner* runner, Real slope) {
  const Real curvature = sum(runner, [&](std::size_t i) { return direction_[i] * product_[i]; });
  return curvature > 0 ? slope / curvature : 0;
}

void Complementarity::take_step(Real length, TaskRunner* runner, SolveReport& report) {
  for_blocks(runner, x.size(), [&](std::size_t begin, std::size_t end) {
    Sums sums;
    for (std::size_t i = begin; i < end; ++i) {
      if (length > 0) {
        x[i] += length * direction_[i];
        excess[i] -= length * product_[i];
      }
      const Real e = x[i] > 0 ? excess[i] : std::max(Real{0}, excess[i]);
      const Real residual = std::abs(e) / scale[i];
      sums.residual += residual;
      sums.greatest = std::max(sums.greatest, residual);
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
