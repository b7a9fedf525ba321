#pragma once

#include <cstdint>
#include <optional>

#include "protocol/frame/grid_frame.h"

namespace vat {

/// Selection and precision of the frames that a client requests.
struct Subscription {
  std::optional<double> max_error;  ///< [m]; 0: the finest grid; absent: the session's default
  std::uint64_t every = 1;          ///< [ticks]
  FrameSelection selection;
  /// Greatest errors of the attributes [m/s], [kg/m^3], [Pa], [m/s^2]; 0: attribute omitted.
  ByAttribute<double> attribute_errors{};
  /// A slow viewer gets fewer frames, but no coarser ones and no fewer particles.
  bool keeps_precision = false;
};

}  // namespace vat
