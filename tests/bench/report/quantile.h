/// Quantiles of measured values.

#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "core/support/check.h"

namespace vat::bench {

/// Returns the value below which the part `share`, 0 to 1, of the values lies: that of the nearest
/// rank. NaN if there are no values.
template <std::floating_point Value>
Value quantile(std::vector<Value> values, double share) {
  VAT_CHECK(share >= 0 && share <= 1);
  if (values.empty()) return std::numeric_limits<Value>::quiet_NaN();
  const auto rank =
      static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::ranges::nth_element(values, values.begin() + rank);
  return values[static_cast<std::size_t>(rank)];
}

template <std::floating_point Value>
Value median(std::vector<Value> values) {
  return quantile(std::move(values), 0.5);
}

}  // namespace vat::bench
