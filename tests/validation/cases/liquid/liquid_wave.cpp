#include "tests/validation/cases/liquid/liquid_wave.h"

#include <algorithm>
#include <cmath>

namespace vat::validation {

Swing observe_swing(Run& run, Real until, const std::function<Real()>& quantity) {
  constexpr Real kInterval = 0.01;
  Swing seen;
  Real before = quantity();
  Real greatest = std::abs(before);
  while (run.simulation().time() < until - kInterval / 2) {
    const Real begin = run.simulation().time();
    run.advance_to(begin + kInterval);
    const Real after = quantity();
    if (before * after < 0) {
      seen.zeros.push_back(begin + kInterval * before / (before - after));
      seen.extremes.push_back(greatest);
      greatest = 0;
    }
    greatest = std::max(greatest, std::abs(after));
    before = after;
  }
  return seen;
}

}  // namespace vat::validation
