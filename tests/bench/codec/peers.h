#pragma once

#include <string>
#include <vector>

#include "protocol/frame/grid_frame.h"

namespace vat::bench {

/// The result of another codec for the positions of the same frames, each coded independently.
struct PeerResult {
  std::string name;
  std::string what;
  bool is_built_in = true;  ///< false: its library was missing at build time
  Real bits = 0;            ///< mean per particle
  Real encode = 0;          ///< [s] per particle, median over frames
  Real decode = 0;
};

/// Measures positions of liquid and deformable bodies. Frames without either are ignored.
std::vector<PeerResult> measure_peers(const std::vector<GridFrame>& frames);

}  // namespace vat::bench
