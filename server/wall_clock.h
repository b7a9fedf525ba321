#pragma once

#include <chrono>

namespace vat {

/// Seconds since 1970.
inline double wall_clock() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

}  // namespace vat
