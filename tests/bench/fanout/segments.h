#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace vat::bench {

/// Values of one kind, measured in several segments of time.
using Segments = std::vector<std::vector<float>>;

/// A ratio of two quantiles, and an interval in which it lies with a probability of 95 %.
struct QuantileRatio {
  double value = 0;
  double low = 0;
  double high = 0;
};

/// Returns the quantile `share` of the values of all segments. NaN if there are no values.
double pooled_quantile(const Segments& segments, double share);

/// Returns pooled_quantile() of `b`, divided by that of `a`. The interval is the middle 95 % of
/// 2000 bootstrap samples. They draw whole segments with replacement, because disturbances of a
/// machine last longer than a value. NaN if either has fewer than five segments.
QuantileRatio quantile_ratio(const Segments& a, const Segments& b, double share);

}  // namespace vat::bench
