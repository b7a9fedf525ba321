#include "tests/validation/cases/liquid/liquid_fit.h"

#include <cstddef>

namespace vat::validation {

Line fitted_line(const std::vector<Real>& x, const std::vector<Real>& y, Real least, Real most) {
  Real count = 0;
  Real sum_x = 0;
  Real sum_y = 0;
  Real sum_xx = 0;
  Real sum_xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] < least || x[i] > most) continue;
    count += 1;
    sum_x += x[i];
    sum_y += y[i];
    sum_xx += x[i] * x[i];
    sum_xy += x[i] * y[i];
  }
  const Real slope = (count * sum_xy - sum_x * sum_y) / (count * sum_xx - sum_x * sum_x);
  return {slope, (sum_y - slope * sum_x) / count};
}

}  // namespace vat::validation
