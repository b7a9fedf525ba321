#include <algorithm>
#include <cmath>

#include "protocol/byte_io.h"
#include "protocol/frame_codec.h"
#include "protocol/frame_layout.h"

namespace vat {
namespace {

using namespace frame_layout;

Error frame_error(const char* code, const char* message) {
  return {code, "", message};
}

Error truncated() {
  return frame_error("truncated", "the frame ends early");
}

template <class Values>
bool all_finite(const Values& values) {
  return std::all_of(values.begin(), values.end(), [](auto value) { return std::isfinite(value); });
}

bool is_unit(const std::array<float, 4>& q) {
  constexpr double kTolerance = 1e-3;  // far above rounding, far below a wrong rotation
  double square = 0;
  for (const float component : q) {
    square += static_cast<double>(component) * static_cast<double>(component);
  }
  return std::abs(square - 1) <= kTolerance;
}

/// Reads the header; its size has been checked.
Result<FrameHeader> read_header(ByteReader& in, std::uint32_t& block_count) {
  if (in.get<std::uint32_t>() != kMagic) return frame_error("bad_magic", "must start with VATF");
  if (in.get<std::uint8_t>() != kVersion) return frame_error("bad_version", "version must be 1");
  if (in.get<std::uint8_t>() != kKeyFrame) {
    return frame_error("bad_type", "type must be 1, a key frame");
  }
  FrameHeader header;
  const auto flags = in.get<std::uint16_t>();
  header.playing = (flags & kPlayingFlag) != 0;
  header.slow = (flags & kSlowFlag) != 0;
  header.epoch = in.get<std::uint32_t>();
  header.sequence = in.get<std::uint32_t>();
  header.tick = in.get<std::uint64_t>();
  header.time = in.get<double>();
  header.published = in.get<double>();
  const auto first_reference = in.get<std::uint32_t>();
  const auto second_reference = in.get<std::uint32_t>();
  header.dropped = in.get<std::uint32_t>();
  block_count = in.get<std::uint32_t>();
  for (double& coordinate : header.origin) coordinate = in.get<double>();
  header.quantum = in.get<double>();
  header.real_time_factor = in.get<float>();
  const auto reserved = in.get<std::uint32_t>();

  if ((flags & ~(kPlayingFlag | kSlowFlag)) != 0 || reserved != 0) {
    return frame_error("bad_header", "unused flags and the reserved field must be 0");
  }
  if (first_reference != 0 || second_reference != 0) {
    return frame_error("bad_header", "a key frame must have no references");
  }
  if (!std::isfinite(header.time) || !std::isfinite(header.published) ||
      !std::isfinite(header.real_time_factor) || !all_finite(header.origin)) {
    return frame_error("bad_header", "times, factor and grid origin must be finite");
  }
  if (!std::isfinite(header.quantum) || header.quantum <= 0) {
    return frame_error("bad_header", "the quantum must be finite and above 0");
  }
  return header;
}

Status read_grid_positions(ByteReader& in, std::uint32_t particles, FrameBlock& block) {
  // Before anything is allocated: the count is the sender's word only.
  if (in.left() / kGridPositionSize < particles) return truncated();
  block.grid_positions.resize(std::size_t{3} * particles);
  for (std::uint16_t& coordinate : block.grid_positions) coordinate = in.get<std::uint16_t>();
  return {};
}

Status read_position(ByteReader& in, FrameBlock& block) {
  for (double& coordinate : block.position) coordinate = in.get<double>();
  if (in.ended_early()) return truncated();
  if (!all_finite(block.position)) return frame_error("bad_block", "a position must be finite");
  return {};
}

Status read_orientation(ByteReader& in, FrameBlock& block) {
  for (float& component : block.orientation) component = in.get<float>();
  if (in.ended_early()) return truncated();
  if (!is_unit(block.orientation)) {  // false for a NaN
    return frame_error("bad_block", "an orientation must be a unit quaternion");
  }
  return {};
}

std::uint8_t encoding_of(FrameBlock::Kind kind) {
  switch (kind) {
    case FrameBlock::Kind::rigid:
      return kPoseEncoding;
    case FrameBlock::Kind::vat:
      return kOffsetEncoding;
    default:
      return kGridEncoding;
  }
}

Status read_block(ByteReader& in, bool first, FrameBlock& block) {
  block.body = in.get<std::uint32_t>();
  const auto kind = in.get<std::uint8_t>();
  const auto encoding = in.get<std::uint8_t>();
  const auto reserved = in.get<std::uint16_t>();
  const auto particles = in.get<std::uint32_t>();
  if (in.ended_early()) return truncated();
  if (kind > static_cast<std::uint8_t>(FrameBlock::Kind::vat)) {
    return frame_error("bad_block", "a block's kind must be from 0 to 3");
  }
  block.kind = static_cast<FrameBlock::Kind>(kind);
  if (encoding != encoding_of(block.kind)) {
    return frame_error("bad_block", "a block's encoding must fit its kind");
  }
  if (reserved != 0 || (encoding != kGridEncoding && particles != 0)) {
    return frame_error("bad_block", "a block's unused fields must be 0");
  }
  if ((block.kind == FrameBlock::Kind::vat) != (block.body == 0)) {
    return frame_error("bad_block", "body 0 must be the vat, and nothing else");
  }
  if (block.kind == FrameBlock::Kind::vat && !first) {
    return frame_error("bad_block", "the vat's block must be the first");
  }
  if (encoding == kGridEncoding) return read_grid_positions(in, particles, block);
  if (Status position = read_position(in, block); !position) return position;
  return encoding == kPoseEncoding ? read_orientation(in, block) : Status{};
}

}  // namespace

Result<Frame> decode_frame(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeaderSize) return truncated();
  ByteReader in(bytes);
  std::uint32_t block_count = 0;
  const Result<FrameHeader> header = read_header(in, block_count);
  if (!header) return header.errors();
  if (in.left() / kBlockHeaderSize < block_count) return truncated();
  Frame frame{header.value(), std::vector<FrameBlock>(block_count)};
  for (FrameBlock& block : frame.blocks) {
    const Status status = read_block(in, &block == frame.blocks.data(), block);
    if (!status) return status.errors();
  }
  if (in.left() != 0) return frame_error("extra_bytes", "the frame has bytes left over");
  return frame;
}

}  // namespace vat
