#pragma once

#include <array>
#include <cstddef>

#include "core/support/check.h"

namespace vat {

/// Names of the values of an enumeration in scene files and messages, in the order of the values.
/// The values begin with 0 and have no gaps.
template <class Enum>
inline constexpr std::array<const char*, 0> kNamesOf{};

template <class Enum>
concept Named = (kNamesOf<Enum>.size() > 0);

template <Named Enum>
const char* to_string(Enum value) {
  const auto index = static_cast<std::size_t>(value);
  VAT_CHECK(index < kNamesOf<Enum>.size());
  return kNamesOf<Enum>[index];
}

}  // namespace vat
