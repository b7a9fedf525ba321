#pragma once

#include <string>
#include <vector>

#include "protocol/frame/grid_frame.h"

namespace vat::bench {

/// What others make of the positions of the same frames, each alone.
struct PeerResult {
  std::string name;
  std::string what;
  bool is_built_in = true;  ///< false: its library was not there when the bench was built
  Real bits = 0;            ///< of a particle, mean
  Real encode = 0;          ///< [s] of a particle, median over frames
  Real decode = 0;
};

/// Of liquid and deformable bodies; frames without either give nothing.
std::vector<PeerResult> measure_peers(const std::vector<GridFrame>& frames);

}  // namespace vat::bench
