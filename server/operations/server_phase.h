#pragma once

#include <atomic>
#include <cstdint>

namespace vat {

/// Phase of a server's life, which "/readyz" reports.
enum class ServerPhase : std::uint8_t { starting, recovering, ready, draining };
const char* to_string(ServerPhase phase);

/// The phase, shared by all threads.
using SharedPhase = std::atomic<ServerPhase>;

}  // namespace vat
