#include "core/contact/projection/sweep_progress.h"

#include <cmath>
#include <limits>

#include "core/support/check.h"

namespace vat {

void SweepProgress::add(Real change) {
  if (rounds_ == next_) {
    next_ *= 2;
    half_ = last_;
  }
  ++rounds_;
  last_ = change;
  if (2 * rounds_ == next_) half_ = change;
}

Real SweepProgress::rounds_left() const {
  VAT_CHECK(has_prediction());
  if (!(last_ < half_)) return std::numeric_limits<Real>::infinity();
  const Real half = static_cast<Real>(rounds_) / 2;
  return half * std::log(last_ / tolerance_) / std::log(half_ / last_);
}

void SweepProgress::restart() {
  if (rounds_ == next_) next_ *= 2;
  rounds_ = 0;
}

}  // namespace vat
