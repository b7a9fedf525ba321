#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "protocol/published/published_state.h"

namespace vat::bench {

/// A simulated scene from which frames are made.
struct CodecScene {
  std::string name;
  Scene scene;
  Real spacing = 0;       ///< [m] particle spacing
  Real begin = 0;         ///< [s] simulated before the first frame
  Real seconds = 0;       ///< recorded
  bool rests = false;     ///< all bodies must sleep at the first frame
  bool is_large = false;  ///< times of its levels of detail are measured, only if it is named
};

/// Frames per second.
inline constexpr Real kFrameRate = 30;

/// Returns the dam breaks of the other codecs' measurements, from the start for four seconds.
/// Further scenes are a pool at rest, and the article's two scenes, moving and at rest. `quick`
/// makes them smaller and shorter.
std::vector<CodecScene> codec_scenes(bool quick);

struct Recording {
  std::vector<PublishedState> states;
  std::size_t particles = 0;  ///< of all bodies
};
/// Records a scene. Throws std::runtime_error if the run fails or does not come to rest.
Recording record(const CodecScene& scene, std::size_t threads);

}  // namespace vat::bench
