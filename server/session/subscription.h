#pragma once

#include <cstdint>

namespace vat {

/// The frames that a client asks for.
struct Subscription {
  double max_error = 0;     ///< [m]; 0: the finest grid
  std::uint64_t every = 1;  ///< [ticks]
};

}  // namespace vat
