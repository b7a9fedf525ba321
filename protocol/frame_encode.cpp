#include "protocol/byte_io.h"
#include "protocol/frame_codec.h"
#include "protocol/frame_layout.h"

namespace vat {
namespace {

using namespace frame_layout;

void put_header(ByteWriter& out, const GridFrame& frame, std::uint8_t stride) {
  const FrameHeader& header = frame.header;
  const int flags = (header.playing ? kPlayingFlag : 0) | (header.slow ? kSlowFlag : 0) |
                    (frame.detail << kDetailShift) | (frame.has_region ? kRegionFlag : 0);
  out.put(kMagic);
  out.put(kVersion);
  out.put(kKeyFrame);
  out.put(static_cast<std::uint8_t>(flags));
  out.put(stride);
  out.put(header.epoch);
  out.put(header.number);
  out.put(std::uint16_t{0});  // a key frame has no references
  out.put(std::uint16_t{0});
  out.put(std::uint32_t{0});
  out.put(header.tick);
  out.put(header.time);
  out.put(header.published);
  out.put(header.real_time_factor);
  for (const double coordinate : frame.scale.grid.origin) out.put(coordinate);
  out.put(frame.scale.grid.quantum);
  for (const double quantum : frame.scale.attribute_quanta) out.put(quantum);
}

void put_block(ByteWriter& out, const GridBlock& block) {
  out.put(block.body);
  out.put(static_cast<std::uint8_t>(block.kind));
  out.put(block.orientation_bits);
  out.put(static_cast<std::uint16_t>(block.numbers.empty() ? 0 : 1));
  out.put(static_cast<std::uint32_t>(block.particle_count()));
  for (const std::uint32_t number : block.numbers) out.put(number);
  for (const std::uint16_t coordinate : block.positions) out.put(coordinate);
  for (const auto& column : block.attributes) {
    for (const std::int32_t value : column) out.put(value);
  }
  if (block.has_particles()) return;
  for (const std::int32_t value : block.place) out.put(value);
  if (block.kind == GridBlock::Kind::vat) return;
  for (const std::int32_t value : block.orientation) out.put(value);
}

}  // namespace

struct FrameEncoder::Impl {
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
  ByteWriter out(0);
  put_header(out, frame, stride);
  out.put(static_cast<std::uint32_t>(frame.blocks.size()));
  for (const GridBlock& block : frame.blocks) put_block(out, block);
  impl_->bytes = out.take();
  return impl_->bytes;
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
