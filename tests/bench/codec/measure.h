#pragma once

#include <cstdint>
#include <vector>

#include "protocol/frame/frame_codec.h"
#include "tests/bench/codec/recording.h"

namespace vat::bench {

/// The frames that a viewer receives of a recording.
struct CodecSetting {
  Real share = 64;   ///< the maximum error is the spacing divided by this
  Real dropped = 0;  ///< randomly dropped fraction of the frames
  std::uint8_t detail = kFullDetail;
};

struct CodecResult {
  std::size_t particles = 0;  ///< mean number per frame, including those of rigid bodies
  std::size_t delta_frames = 0;
  Real delta_bytes = 0;  ///< mean of complete frames
  Real key_bytes = 0;
  Real encode = 0;  ///< median over frames [s]
  Real decode = 0;
  Real encode_key = 0;
  Real decode_key = 0;
  Real worst_error = 0;  ///< of a position, relative to the maximum error

  Real bits(Real bytes) const { return 8 * bytes / static_cast<Real>(particles); }
};

/// Returns the frames of a session with this maximum error.
std::vector<GridFrame> on_grids(const Recording& recording, Real max_error);

/// Encodes frames as a server does for one client, relative to the last two received frames. Throws
/// std::runtime_error if a decoder gives other integers.
CodecResult measure_codec(const Recording& recording, const std::vector<GridFrame>& frames,
                          const CodecSetting& setting);

}  // namespace vat::bench
