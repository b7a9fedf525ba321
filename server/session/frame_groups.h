#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vat {

/// Viewers that one encoding serves.
struct GroupClaim {
  std::size_t viewers = 0;
  /// The most frames that one of them has missed in a row because its group was not served.
  std::size_t passed_over = 0;
};

/// Which groups are served where there are more than `places` (2 at least): indices, the first ones
/// first. Half of the places are for the largest groups, so that a few odd viewers take nothing
/// from many; the others for those that have waited longest, so that nobody waits for ever: with g
/// groups a viewer is passed over at most g / (places / 2) times in a row.
std::vector<std::size_t> choose_groups(std::span<const GroupClaim> claims, std::size_t places);

}  // namespace vat
