#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "tests/bench/soak/tally.h"

namespace vat::bench {

/// The server of the clients.
struct SoakPlace {
  std::uint16_t port = 0;
  std::string session;
};

/// Behaviour of a client. The first four are well-behaved: each of their requests must be answered.
enum class Manner {
  steady,    ///< sends commands of all kinds and queries
  grabbing,  ///< grabs, moves and releases bodies, disconnects, and resumes
  restless,  ///< joins, sometimes creates a session, and leaves in one of three ways
  stalling,  ///< stops reading temporarily, then continues or disconnects
  flooding,  ///< sends faster than permitted until it is closed
  rubbish,   ///< sends invalid messages
};
inline constexpr int kManners = 6;

/// Runs a client until `stop`. Its failures are recorded in the tally. `seed` determines its
/// choices.
void run_soak_client(Manner manner, const SoakPlace& place, std::uint32_t seed,
                     const std::atomic<bool>& stop, Tally& tally);

}  // namespace vat::bench
