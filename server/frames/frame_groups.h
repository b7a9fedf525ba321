#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vat {

/// Viewers that one encoding serves.
struct GroupClaim {
  std::size_t viewers = 0;
  /// The greatest number of consecutive times that a viewer of the group was not served.
  std::size_t passed_over = 0;
};

/// Returns the indices of the groups to serve, in ascending order. There must be more than `places`
/// groups, and `places` must be at least 2. Half of the places are for the largest groups, and the
/// others for those that have waited longest. With g groups, a viewer is therefore passed over at
/// most g / (places / 2) times in a row.
std::vector<std::size_t> choose_groups(std::span<const GroupClaim> claims, std::size_t places);

}  // namespace vat
