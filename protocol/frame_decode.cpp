#include <algorithm>
#include <cmath>

#include "protocol/byte_io.h"
#include "protocol/frame_codec.h"
#include "protocol/frame_layout.h"

namespace vat {
namespace {

using namespace frame_layout;

constexpr std::size_t kBlockBytes = 12;

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

Status read_header(ByteReader& in, GridFrame& frame) {
  if (in.get<std::uint32_t>() != kMagic) return frame_error("bad_magic", "must start with VATF");
  if (in.get<std::uint8_t>() != kVersion) return frame_error("bad_version", "version must be 2");
  if (in.get<std::uint8_t>() != kKeyFrame) return frame_error("bad_type", "must be a key frame");
  FrameHeader& header = frame.header;
  const auto flags = in.get<std::uint8_t>();
  header.playing = (flags & kPlayingFlag) != 0;
  header.slow = (flags & kSlowFlag) != 0;
  frame.detail = (flags >> kDetailShift) & kFullDetail;
  frame.has_region = (flags & kRegionFlag) != 0;
  header.stride = in.get<std::uint8_t>();
  header.epoch = in.get<std::uint32_t>();
  header.number = in.get<std::uint32_t>();
  const auto references = in.get<std::uint32_t>();
  const auto check = in.get<std::uint32_t>();
  header.tick = in.get<std::uint64_t>();
  header.time = in.get<double>();
  header.published = in.get<double>();
  header.real_time_factor = in.get<float>();
  if ((flags & ~kKnownFlags) != 0 || header.stride == 0 || references != 0 || check != 0) {
    return frame_error("bad_header", "unused fields must be 0, and the stride above it");
  }
  if (!std::isfinite(header.time) || !std::isfinite(header.published) ||
      !std::isfinite(header.real_time_factor)) {
    return frame_error("bad_header", "times and factor must be finite");
  }
  return {};
}

Status read_scale(ByteReader& in, FrameScale& scale) {
  for (double& coordinate : scale.grid.origin) coordinate = in.get<double>();
  scale.grid.quantum = in.get<double>();
  for (double& quantum : scale.attribute_quanta) quantum = in.get<double>();
  if (in.ended_early()) return truncated();
  if (!all_finite(scale.grid.origin) || !std::isfinite(scale.grid.quantum) ||
      scale.grid.quantum <= 0 || !all_finite(scale.attribute_quanta) ||
      std::ranges::any_of(scale.attribute_quanta, [](double q) { return q < 0; })) {
    return frame_error("bad_header", "the grid must be finite, and its quanta above 0");
  }
  return {};
}

Status read_particles(ByteReader& in, std::uint32_t count, bool numbered, const FrameScale& scale,
                      GridBlock& block) {
  // Before anything is allocated: the count is the sender's word only.
  if (in.left() / 6 < count) return truncated();
  if (numbered) {
    block.numbers.resize(count);
    for (std::uint32_t& number : block.numbers) number = in.get<std::uint32_t>();
    if (std::ranges::adjacent_find(block.numbers, std::ranges::greater_equal{}) !=
        block.numbers.end()) {
      return frame_error("bad_block", "numbers must rise");
    }
  }
  block.positions.resize(std::size_t{3} * count);
  for (std::uint16_t& coordinate : block.positions) coordinate = in.get<std::uint16_t>();
  for (std::size_t a = 0; a < kFrameAttributes; ++a) {
    if (!has_attribute(block.kind, scale, a)) continue;
    block.attributes[a].resize(count);
    for (std::int32_t& value : block.attributes[a]) value = in.get<std::int32_t>();
  }
  return in.ended_early() ? Status(truncated()) : Status{};
}

Status read_block(ByteReader& in, bool first, const FrameScale& scale, GridBlock& block) {
  block.body = in.get<std::uint32_t>();
  const auto kind = in.get<std::uint8_t>();
  block.orientation_bits = in.get<std::uint8_t>();
  const auto numbered = in.get<std::uint16_t>();
  const auto count = in.get<std::uint32_t>();
  if (in.ended_early()) return truncated();
  if (kind > static_cast<std::uint8_t>(GridBlock::Kind::vat) || numbered > 1) {
    return frame_error("bad_block", "a block's kind must be from 0 to 3");
  }
  block.kind = static_cast<GridBlock::Kind>(kind);
  if ((block.kind == GridBlock::Kind::vat) != (block.body == 0)) {
    return frame_error("bad_block", "body 0 must be the vat, and nothing else");
  }
  if (block.kind == GridBlock::Kind::vat && !first) {
    return frame_error("bad_block", "the vat's block must be the first");
  }
  if (block.has_particles()) return read_particles(in, count, numbered == 1, scale, block);
  if (count != 0) return frame_error("bad_block", "a block's unused fields must be 0");
  for (std::int32_t& value : block.place) value = in.get<std::int32_t>();
  if (block.kind == GridBlock::Kind::rigid) {
    for (std::int32_t& value : block.orientation) value = in.get<std::int32_t>();
  }
  if (in.ended_early()) return truncated();
  return {};
}

}  // namespace

struct FrameDecoder::Impl {
  GridFrame frame;
};

FrameDecoder::FrameDecoder() : impl_(std::make_unique<Impl>()) {}
FrameDecoder::~FrameDecoder() = default;
FrameDecoder::FrameDecoder(FrameDecoder&&) noexcept = default;
FrameDecoder& FrameDecoder::operator=(FrameDecoder&&) noexcept = default;

Result<const GridFrame*> FrameDecoder::decode(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeaderSize + kScaleSize) return truncated();
  ByteReader in(bytes);
  GridFrame frame;
  if (Status header = read_header(in, frame); !header) return header.errors();
  if (Status scale = read_scale(in, frame.scale); !scale) return scale.errors();
  const auto count = in.get<std::uint32_t>();
  if (in.ended_early() || in.left() / kBlockBytes < count) return truncated();
  frame.blocks.resize(count);
  for (GridBlock& block : frame.blocks) {
    const Status status = read_block(in, &block == frame.blocks.data(), frame.scale, block);
    if (!status) return status.errors();
  }
  if (in.left() != 0) return frame_error("extra_bytes", "the frame has bytes left over");
  impl_->frame = std::move(frame);
  return &impl_->frame;
}

Result<GridFrame> decode_key_frame(std::span<const std::uint8_t> bytes) {
  FrameDecoder decoder;
  const Result<const GridFrame*> frame = decoder.decode(bytes);
  if (!frame) return frame.errors();
  return *frame.value();
}

}  // namespace vat
