#include "server/frames/frame_groups.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include "core/support/check.h"

namespace vat {

std::vector<std::size_t> choose_groups(std::span<const GroupClaim> claims, std::size_t places) {
  VAT_CHECK(places >= 2);
  std::vector<std::size_t> order(claims.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater{},
                           [&](std::size_t i) { return claims[i].viewers; });
  if (order.size() <= places) return order;
  const auto rest = order.begin() + static_cast<std::ptrdiff_t>(places - places / 2);
  std::ranges::stable_sort(rest, order.end(), std::ranges::greater{}, [&](std::size_t i) {
    return std::tuple(claims[i].passed_over, claims[i].viewers);
  });
  order.resize(places);
  return order;
}

}  // namespace vat
