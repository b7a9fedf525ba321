#pragma once

#include <cstdint>
#include <vector>

#include "protocol/frame/frame_codec.h"
#include "tests/bench/codec/recording.h"

namespace vat::bench {

/// What a viewer gets of a recording.
struct CodecSetting {
  Real share = 64;   ///< the greatest error is the spacing over this
  Real dropped = 0;  ///< part of the frames, at random
  std::uint8_t detail = kFullDetail;
};

struct CodecResult {
  std::size_t particles = 0;  ///< that frames have on average, those of rigid bodies included
  std::size_t delta_frames = 0;
  Real delta_bytes = 0;  ///< mean, of whole frames
  Real key_bytes = 0;
  Real encode = 0;  ///< median over frames [s]
  Real decode = 0;
  Real encode_key = 0;
  Real decode_key = 0;
  Real worst_error = 0;  ///< of a position, in greatest errors

  Real bits(Real bytes) const { return 8 * bytes / static_cast<Real>(particles); }
};

/// The recording on the grids of a session that is asked for this error.
std::vector<GridFrame> on_grids(const Recording& recording, Real max_error);

/// Frames as a server sends them to one client: on the last two that it got. Throws
/// std::runtime_error where a decoder does not end in the same integers.
CodecResult measure_codec(const Recording& recording, const std::vector<GridFrame>& frames,
                          const CodecSetting& setting);

/// The value below which this part of them lies; 0 of none.
Real quantile(std::vector<Real> values, Real part);
Real median(std::vector<Real> values);

}  // namespace vat::bench
