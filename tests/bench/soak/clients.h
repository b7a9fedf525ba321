#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "tests/bench/soak/tally.h"

namespace vat::bench {

/// Whom the clients of a soak talk to.
struct SoakPlace {
  std::uint16_t port = 0;
  std::string session;
};

/// Manners of clients. The first four behave: each of their requests has to be answered.
enum class Manner {
  steady,    ///< gives commands of all kinds, and looks at the state
  grabbing,  ///< holds bodies and moves them, lets go, breaks off, and resumes
  restless,  ///< joins, makes a session of its own at times, and leaves in one of three ways
  stalling,  ///< stops reading for a while, and goes on or breaks off
  flooding,  ///< sends faster than is allowed, until it is closed
  rubbish,   ///< sends what makes no sense
};
inline constexpr int kManners = 6;

/// A client until `stop`; what goes wrong for it is in the tally. `seed` makes its choices.
void run_soak_client(Manner manner, const SoakPlace& place, std::uint32_t seed,
                     const std::atomic<bool>& stop, Tally& tally);

}  // namespace vat::bench
