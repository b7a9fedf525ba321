#include "tests/bench/soak/trend.h"

#include <cstddef>
#include <stdexcept>

namespace vat::bench {

double find_growth(const std::vector<double>& values) {
  if (values.size() < 2) throw std::invalid_argument("too few values for a line");
  const double length = static_cast<double>(values.size()) - 1;
  double spread = 0;  // of the indices
  double slope = 0;   // per value
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double place = static_cast<double>(i) - length / 2;
    spread += place * place;
    slope += place * values[i];
  }
  return slope / spread * length;
}

bool is_flat(const std::vector<double>& resting, double most_growth) {
  if (resting.size() < 3) throw std::invalid_argument("too few rests");
  return find_growth({resting.begin() + 1, resting.end()}) <= most_growth * resting[1];
}

}  // namespace vat::bench
