#include "protocol/neighbourhood.h"

namespace vat {

const std::array<std::int32_t, kInverses>& inverses() {
  static const auto kAll = [] {
    std::array<std::int32_t, kInverses> all{};
    for (std::size_t n = 1; n < kInverses; ++n) all[n] = 65536 / static_cast<std::int32_t>(n);
    return all;
  }();
  return kAll;
}

}  // namespace vat
