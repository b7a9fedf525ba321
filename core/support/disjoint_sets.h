#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/support/check.h"
#include "core/types.h"

namespace vat {

/// A partition of the numbers from 0 to count - 1 into sets.
class DisjointSets {
 public:
  /// Puts each number into a set of its own.
  void reset(std::size_t count) {
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }
  /// Returns the lowest number of the set of `number`.
  Index root(Index number) {
    VAT_CHECK(number < parent_.size());
    while (parent_[number] != number) number = parent_[number] = parent_[parent_[number]];
    return number;
  }
  void join(Index a, Index b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace vat
