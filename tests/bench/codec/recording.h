#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "protocol/frame/published_state.h"

namespace vat::bench {

/// A run of which frames are made.
struct CodecScene {
  std::string name;
  Scene scene;
  Real spacing = 0;    ///< [m] of the particles
  Real begin = 0;      ///< [s] simulated before the first frame
  Real seconds = 0;    ///< recorded
  bool rests = false;  ///< all bodies must sleep when the first frame is taken
};

/// Frames a second.
inline constexpr Real kFrameRate = 30;

/// The dam breaks by which the peers' codecs were measured, from the start and for four seconds; a
/// pool, settled and asleep; the paper's two scenes, in motion and at rest. `quick`: smaller and
/// shorter.
std::vector<CodecScene> codec_scenes(bool quick);

struct Recording {
  std::vector<PublishedState> states;
  std::size_t particles = 0;  ///< of all bodies
};
/// Throws std::runtime_error where the run fails, or does not come to rest.
Recording record(const CodecScene& scene, std::size_t threads);

}  // namespace vat::bench
