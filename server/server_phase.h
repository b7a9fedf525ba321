#pragma once

#include <atomic>
#include <cstdint>

namespace vat {

/// Where a server is between its start and its end: what "/readyz" tells.
enum class ServerPhase : std::uint8_t { starting, recovering, ready, draining };
const char* to_string(ServerPhase phase);

/// The phase as all threads see it.
using SharedPhase = std::atomic<ServerPhase>;

}  // namespace vat
