#pragma once

#include <vector>

#include "core/types.h"
#include "tests/bench/report/table.h"
#include "tests/bench/speed/measure.h"

namespace vat::bench {

/// The best figure of SPlisHSPlasH 2.16 for a dam break, on 4 cores of a Xeon at 2.5 GHz (AVX-512,
/// built with AVX2 by g++ 12 -O3 on Debian 12), best of 2 to 6 runs.
struct PeerFigure {
  const char* name;  ///< of our case
  std::size_t threads;
  Real wall_per_simulated;  ///< [s/s] with what was its fastest kind of walls
  Real density_error;       ///< mean, of that run
  const char* solver;
};

/// The peer's figure for a row; null where it has none.
const PeerFigure* find_peer(const SpeedRow& row);

/// Our rows beside the peer's.
Table peer_table(const std::vector<SpeedRow>& rows);

}  // namespace vat::bench
