#pragma once

#include <vector>

namespace vat::bench {

/// Returns the growth from the first to the last value, by linear regression. Throws
/// std::invalid_argument if there are fewer than two values.
double find_growth(const std::vector<double>& values);

/// Returns whether the values at rest grow by at most the fraction `most_growth`, without the first
/// value, which is the warm-up. Throws std::invalid_argument if there are fewer than three.
bool is_flat(const std::vector<double>& resting, double most_growth);

}  // namespace vat::bench
