#pragma once

#include <atomic>
#include <cstdint>

#include "core/support/names.h"

namespace vat {

/// Phase of a server, reported by "/readyz".
enum class ServerPhase : std::uint8_t {
  starting,
  recovering,
  ready,
  draining,
  replaced,  ///< another process has the name of this node of a cluster
};
template <>
inline constexpr std::array kNamesOf<ServerPhase>{"starting", "recovering", "ready", "draining",
                                                  "replaced"};

/// Phase of the server, shared by all threads.
using SharedPhase = std::atomic<ServerPhase>;

}  // namespace vat
