#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/support/result.h"
#include "protocol/frame/grid_frame.h"

namespace vat::bench {

/// Of the frames that are also coded as key frames.
inline constexpr std::size_t kKeyInterval = 10;

using FrameBytes = std::vector<std::uint8_t>;

/// What a decoder is timed with, in the order of decoding: each frame on the two before it, as a
/// client gets them; then each kKeyInterval-th once more as a key frame.
std::vector<FrameBytes> stream_of(const std::vector<GridFrame>& frames);

/// Writes each frame behind the number of its bytes (u32, little-endian).
Status write_stream(const std::vector<FrameBytes>& stream, const std::filesystem::path& file);

}  // namespace vat::bench
