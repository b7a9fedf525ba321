#include <algorithm>
#include <cmath>
#include <utility>

#include "core/support/byte_io.h"
#include "protocol/frame/block_coder.h"
#include "protocol/frame/frame_check.h"
#include "protocol/frame/frame_codec.h"
#include "protocol/frame/frame_layout.h"

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

/// Header fields that describe the coding of the frame.
struct Coding {
  bool is_key = false;
  std::array<std::uint16_t, 2> distances{};
  std::uint32_t check = 0;
  bool has_acceleration = false;  ///< key frames only
};

Status read_header(ByteReader& in, GridFrame& frame, Coding& coding) {
  if (in.get<std::uint32_t>() != kMagic) return frame_error("bad_magic", "must start with VATF");
  if (in.get<std::uint8_t>() != kVersion) return frame_error("bad_version", "version must be 2");
  const auto type = in.get<std::uint8_t>();
  if (type != kKeyFrame && type != kDeltaFrame) {
    return frame_error("bad_type", "type must be 1, a key frame, or 2, a delta frame");
  }
  coding.is_key = type == kKeyFrame;
  FrameHeader& header = frame.header;
  const auto flags = in.get<std::uint8_t>();
  header.playing = (flags & kPlayingFlag) != 0;
  header.slow = (flags & kSlowFlag) != 0;
  frame.detail = (flags >> kDetailShift) & kFullDetail;
  frame.has_region = (flags & kRegionFlag) != 0;
  coding.has_acceleration = (flags & kAccelerationFlag) != 0;
  header.stride = in.get<std::uint8_t>();
  header.epoch = in.get<std::uint32_t>();
  header.number = in.get<std::uint32_t>();
  for (std::uint16_t& distance : coding.distances) distance = in.get<std::uint16_t>();
  coding.check = in.get<std::uint32_t>();
  header.tick = in.get<std::uint64_t>();
  header.time = in.get<double>();
  header.published = in.get<double>();
  header.real_time_factor = in.get<float>();
  const int known = coding.is_key ? kKnownFlags | kAccelerationFlag : kKnownFlags;
  if ((flags & ~known) != 0 || header.stride == 0) {
    return frame_error("bad_header", "unused flags must be 0, and the stride above 0");
  }
  if (!std::isfinite(header.time) || !std::isfinite(header.published) ||
      !std::isfinite(header.real_time_factor)) {
    return frame_error("bad_header", "times and factor must be finite");
  }
  const auto [first, second] = coding.distances;
  if (coding.is_key ? first != 0 || second != 0 : first == 0 || (second != 0 && second <= first)) {
    return frame_error("bad_header", "references must be earlier frames, the nearer one first");
  }
  return {};
}

Status read_scale(ByteReader& in, bool accelerations, FrameScale& scale) {
  if (in.left() < kScaleSize + (accelerations ? sizeof(double) : 0)) return truncated();
  for (double& coordinate : scale.grid.origin) coordinate = in.get<double>();
  scale.grid.quantum = in.get<double>();
  scale.attribute_quanta = {};
  const std::size_t count = accelerations ? kFrameAttributes : kScaleAttributes;
  for (std::size_t a = 0; a < count; ++a) scale.attribute_quanta[a] = in.get<double>();
  if (!all_finite(scale.grid.origin) || !std::isfinite(scale.grid.quantum) ||
      scale.grid.quantum <= 0 || !all_finite(scale.attribute_quanta) ||
      std::ranges::any_of(scale.attribute_quanta, [](double q) { return q < 0; })) {
    return frame_error("bad_header", "the grid must be finite, and its quanta above 0");
  }
  if (accelerations && !has_acceleration(scale)) {
    return frame_error("bad_header", "the quantum of accelerations must be above 0");
  }
  return {};
}

/// Returns whether the vat, and only the vat, has body 0, and is the first block.
bool are_in_order(const GridFrame& frame) {
  for (const GridBlock& block : frame.blocks) {
    const bool is_vat = block.kind == GridBlock::Kind::vat;
    if (is_vat != (block.body == 0)) return false;
    if (is_vat && &block != frame.blocks.data()) return false;
  }
  return true;
}

void read_key_blocks(SymbolReader& reader, GridFrame& frame, BlockScratch& scratch) {
  const std::uint32_t count = reader.whole(0);
  if (!reader.may_hold(count)) return reader.refuse();
  frame.blocks.resize(count);
  for (GridBlock& block : frame.blocks) {
    code_key_block(reader, frame.scale, block, scratch);
    if (!reader.is_sound()) return;
  }
  if (!are_in_order(frame)) reader.refuse();
}

void read_delta_blocks(SymbolReader& reader, const FrameReferences& references, GridFrame& frame,
                       BlockScratch& scratch) {
  const auto& [first, second] = references;
  const std::int32_t turn = code_factor(reader, 0);
  frame.blocks.resize(first->blocks.size());
  bool before = false;
  for (std::size_t b = 0; b < frame.blocks.size(); ++b) {
    GridBlock& block = frame.blocks[b];
    before = reader.flag(false, kChangeChances[before ? 1 : 0]);
    if (!before) {
      block = first->blocks[b];
      continue;
    }
    code_delta_block(reader, frame.scale, first->blocks[b],
                     second != nullptr ? &second->blocks[b] : nullptr, turn, block, scratch);
    if (!reader.is_sound()) return;
  }
}

}  // namespace

struct FrameDecoder::Impl {
  /// A ring buffer; `next` is the index of the frame that is being read.
  std::array<GridFrame, kFrameRing + 1> ring;
  std::size_t next = 0;
  std::size_t count = 0;  ///< number of possible references before `next`
  BlockScratch scratch;

  const GridFrame* find(std::uint32_t number, std::uint32_t epoch) const {
    for (std::size_t back = 1; back <= count; ++back) {
      const GridFrame& frame = ring[(next + ring.size() - back) % ring.size()];
      if (frame.header.number == number && frame.header.epoch == epoch) return &frame;
    }
    return nullptr;
  }
  Status read_blocks(std::span<const std::uint8_t> bytes, const FrameReferences& references,
                     GridFrame& frame);
};

Status FrameDecoder::Impl::read_blocks(std::span<const std::uint8_t> bytes,
                                       const FrameReferences& references, GridFrame& frame) {
  SymbolReader reader(bytes);
  if (reader.is_sound()) {
    if (references.first == nullptr) {
      read_key_blocks(reader, frame, scratch);
    } else {
      read_delta_blocks(reader, references, frame, scratch);
    }
  }
  if (reader.was_refused()) {
    return frame_error("bad_block", "a block has an invalid code");
  }
  if (reader.coder().ended_early()) return truncated();
  if (reader.coder().bytes_left() != 0) {
    return frame_error("extra_bytes", "the frame has extra bytes at its end");
  }
  if (!reader.coder().is_at_start()) {
    return frame_error("bad_block", "the decoder's final state is invalid");
  }
  return {};
}

FrameDecoder::FrameDecoder() : impl_(std::make_unique<Impl>()) {}
FrameDecoder::~FrameDecoder() = default;
FrameDecoder::FrameDecoder(FrameDecoder&&) noexcept = default;
FrameDecoder& FrameDecoder::operator=(FrameDecoder&&) noexcept = default;

Result<const GridFrame*> FrameDecoder::decode(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeaderSize) return truncated();
  Impl& own = *impl_;
  ByteReader in(bytes);
  GridFrame& frame = own.ring[own.next];
  Coding coding;
  if (Status header = read_header(in, frame, coding); !header) return header.errors();
  FrameReferences references;
  if (coding.is_key) {
    if (Status scale = read_scale(in, coding.has_acceleration, frame.scale); !scale) {
      return scale.errors();
    }
  } else {
    const auto [first, second] = coding.distances;
    const auto& [number, epoch] = std::pair(frame.header.number, frame.header.epoch);
    references.first = own.find(number - first, epoch);
    references.second = second == 0 ? nullptr : own.find(number - second, epoch);
    if (references.first == nullptr || (second != 0 && references.second == nullptr)) {
      return frame_error("missing_reference", "a reference of the frame is not stored");
    }
    frame.scale = references.first->scale;
  }
  const Status blocks = own.read_blocks(bytes.last(in.left()), references, frame);
  if (!blocks) return blocks.errors();
  if (frame_check(frame) != coding.check) {
    return frame_error("bad_check", "the checksum does not match the decoded frame");
  }
  own.count = coding.is_key ? 1 : std::min(own.count + 1, kFrameRing);
  own.next = (own.next + 1) % own.ring.size();
  return &frame;
}

Result<GridFrame> decode_key_frame(std::span<const std::uint8_t> bytes) {
  FrameDecoder decoder;
  const Result<const GridFrame*> frame = decoder.decode(bytes);
  if (!frame) return frame.errors();
  return *frame.value();
}

}  // namespace vat
