#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/support/result.h"
#include "protocol/frame/grid_frame.h"

namespace vat::bench {

/// Interval of the frames that are also coded as key frames.
inline constexpr std::size_t kKeyInterval = 10;

using FrameBytes = std::vector<std::uint8_t>;

/// Returns the frames for timing a decoder, in decoding order. Each frame refers to the two before
/// it, as for a client. Each kKeyInterval-th follows again as a key frame.
std::vector<FrameBytes> stream_of(const std::vector<GridFrame>& frames);

/// Writes each frame, preceded by the number of its bytes (u32, little-endian).
Status write_stream(const std::vector<FrameBytes>& stream, const std::filesystem::path& file);

}  // namespace vat::bench
