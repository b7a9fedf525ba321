#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vat {

/// Group of viewers that share one encoding.
struct GroupClaim {
  std::size_t viewers = 0;
  /// Greatest number of consecutive states that a viewer of the group did not receive.
  std::size_t passed_over = 0;
};

/// Returns the indices of the groups to serve, in ascending order. There must be more than `places`
/// groups, and `places` must be at least 2. Half of the places are for the largest groups, and the
/// others for the groups with the longest wait. With g groups, a viewer therefore misses at most g
/// / (places / 2) consecutive states.
std::vector<std::size_t> choose_groups(std::span<const GroupClaim> claims, std::size_t places);

}  // namespace vat
