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

/// The value that a share of all has not above it, of all segments together. NaN where there is no
/// value.
double pooled_quantile(const Segments& segments, double share);

/// pooled_quantile() of `b` over that of `a`. The interval is that of a bootstrap which draws whole
/// segments, with replacement, for what disturbs a machine lasts longer than a value: the middle
/// 95 % of 2000 draws. NaN where either has fewer than five segments: too few to draw from.
QuantileRatio quantile_ratio(const Segments& a, const Segments& b, double share);

}  // namespace vat::bench
