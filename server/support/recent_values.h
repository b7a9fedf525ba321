#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace vat {

/// The last 512 values of a sequence, for their quantiles.
class RecentValues {
 public:
  void add(double value) {
    values_[next_] = value;
    next_ = (next_ + 1) % values_.size();
    count_ = std::min(count_ + 1, values_.size());
  }
  /// Returns the quantile of `share` (0 to 1), or 0 without values.
  double quantile(double share) const {
    if (count_ == 0) return 0;
    std::vector<double> values(values_.begin(), values_.begin() + static_cast<long>(count_));
    const auto rank = static_cast<long>(share * static_cast<double>(count_ - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
  }

 private:
  std::array<double, 512> values_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace vat
