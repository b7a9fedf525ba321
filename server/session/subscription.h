#pragma once

#include <cstdint>
#include <optional>

#include "protocol/frame/grid_frame.h"

namespace vat {

/// The frames that a client asks for: the best that it gets.
struct Subscription {
  std::optional<double> max_error;  ///< [m]; 0: the finest grid; none: the session's default
  std::uint64_t every = 1;          ///< [ticks]
  FrameSelection selection;
  /// [m/s], [kg/m^3], [Pa]; 0: without the attribute.
  ByAttribute<double> attribute_errors{};
};

}  // namespace vat
