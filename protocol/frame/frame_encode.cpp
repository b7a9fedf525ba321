#include <algorithm>
#include <cmath>

#include "core/support/byte_io.h"
#include "protocol/frame/block_coder.h"
#include "protocol/frame/frame_check.h"
#include "protocol/frame/frame_codec.h"
#include "protocol/frame/frame_layout.h"

namespace vat {
namespace {

using namespace frame_layout;

std::uint16_t distance(const GridFrame& frame, const GridFrame* reference) {
  if (reference == nullptr) return 0;
  return static_cast<std::uint16_t>(frame.header.number - reference->header.number);
}

void put_header(ByteWriter& out, const GridFrame& frame, const FrameReferences& references,
                std::uint8_t stride) {
  const FrameHeader& header = frame.header;
  const bool is_key = references.first == nullptr;
  const bool accelerations = is_key && has_acceleration(frame.scale);
  const int flags = (header.playing ? kPlayingFlag : 0) | (header.slow ? kSlowFlag : 0) |
                    (frame.detail << kDetailShift) | (frame.has_region ? kRegionFlag : 0) |
                    (accelerations ? kAccelerationFlag : 0);
  out.put(kMagic);
  out.put(kVersion);
  out.put(is_key ? kKeyFrame : kDeltaFrame);
  out.put(static_cast<std::uint8_t>(flags));
  out.put(stride);
  out.put(header.epoch);
  out.put(header.number);
  out.put(distance(frame, references.first));
  out.put(distance(frame, references.second));
  out.put(frame_check(frame));
  out.put(header.tick);
  out.put(header.time);
  out.put(header.published);
  out.put(header.real_time_factor);
  if (!is_key) return;
  for (const double coordinate : frame.scale.grid.origin) out.put(coordinate);
  out.put(frame.scale.grid.quantum);
  const std::size_t count = accelerations ? kFrameAttributes : kScaleAttributes;
  for (std::size_t a = 0; a < count; ++a) out.put(frame.scale.attribute_quanta[a]);
}

void write_key_blocks(const GridFrame& frame, SymbolWriter& writer, BlockScratch& scratch) {
  writer.whole(static_cast<std::uint32_t>(frame.blocks.size()));
  for (const GridBlock& block : frame.blocks) code_key_block(writer, frame.scale, block, scratch);
}

/// Returns the extrapolation factor of poses, in 256ths, from the times of frame and references.
std::int32_t turn_of(const GridFrame& frame, const GridFrame& first, const GridFrame* second) {
  if (second == nullptr) return 0;
  const double now = frame.header.time - first.header.time;
  const double before = first.header.time - second->header.time;
  if (!(before > 0)) return 0;
  return static_cast<std::int32_t>(
      std::clamp(std::round(256 * now / before), 0.0, kFactorOffset - 1.0));
}

void write_delta_blocks(const GridFrame& frame, const GridFrame& first, const GridFrame* second,
                        SymbolWriter& writer, BlockScratch& scratch) {
  const std::int32_t turn = code_factor(writer, turn_of(frame, first, second));
  bool before = false;
  for (std::size_t b = 0; b < frame.blocks.size(); ++b) {
    const GridBlock& last = first.blocks[b];
    before = writer.flag(!(frame.blocks[b] == last), kChangeChances[before ? 1 : 0]);
    if (!before) continue;
    code_delta_block(writer, frame.scale, last, second != nullptr ? &second->blocks[b] : nullptr,
                     turn, frame.blocks[b], scratch);
  }
}

}  // namespace

struct FrameEncoder::Impl {
  SymbolWriter writer;
  BlockScratch scratch;
  std::vector<std::uint8_t> bytes;
};

FrameEncoder::FrameEncoder() : impl_(std::make_unique<Impl>()) {}
FrameEncoder::~FrameEncoder() = default;
FrameEncoder::FrameEncoder(FrameEncoder&&) noexcept = default;
FrameEncoder& FrameEncoder::operator=(FrameEncoder&&) noexcept = default;

bool can_refer(const GridFrame& frame, const GridFrame& reference) {
  const std::uint32_t distance = frame.header.number - reference.header.number;
  return frame.header.number > reference.header.number && distance <= kMaxReferenceDistance &&
         frame.header.epoch == reference.header.epoch && frame.scale == reference.scale &&
         std::ranges::equal(frame.blocks, reference.blocks, [](const auto& a, const auto& b) {
           return a.body == b.body && a.kind == b.kind && a.orientation_bits == b.orientation_bits;
         });
}

std::span<const std::uint8_t> FrameEncoder::encode(const GridFrame& frame,
                                                   const FrameReferences& references,
                                                   std::uint8_t stride) {
  const auto& [first, second] = references;
  VAT_CHECK(first != nullptr ? can_refer(frame, *first) : second == nullptr);
  VAT_CHECK(second == nullptr || can_refer(*first, *second));
  Impl& own = *impl_;
  own.bytes.clear();
  ByteWriter out(own.bytes);
  put_header(out, frame, references, stride);
  own.writer.clear();
  if (first == nullptr) {
    write_key_blocks(frame, own.writer, own.scratch);
  } else {
    write_delta_blocks(frame, *first, second, own.writer, own.scratch);
  }
  own.writer.finish(own.bytes);
  return own.bytes;
}

std::uint32_t frame_number(std::span<const std::uint8_t> frame) {
  VAT_CHECK(frame.size() >= kHeaderSize);
  return ByteReader(frame.subspan(kNumberOffset)).get<std::uint32_t>();
}

bool is_key_frame(std::span<const std::uint8_t> frame) {
  VAT_CHECK(frame.size() >= kHeaderSize);
  return frame[kTypeOffset] == kKeyFrame;
}

std::vector<std::uint8_t> encode_key_frame(const GridFrame& frame) {
  FrameEncoder encoder;
  const auto bytes = encoder.encode(frame, {});
  return {bytes.begin(), bytes.end()};
}

}  // namespace vat
