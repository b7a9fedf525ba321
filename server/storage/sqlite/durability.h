#pragma once

#include <array>

#include "core/support/names.h"

namespace vat {

/// Failures that a completed write survives.
enum class Durability {
  process,  ///< a crash of the process: writes are not synchronised with the disk
  power     ///< also a power failure or a crash of the system
};
template <>
inline constexpr std::array kNamesOf<Durability>{"process", "power"};

}  // namespace vat
