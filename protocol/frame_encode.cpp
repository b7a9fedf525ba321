#include <algorithm>
#include <cmath>

#include "protocol/byte_io.h"
#include "protocol/frame_codec.h"
#include "protocol/frame_layout.h"

namespace vat {
namespace {

using namespace frame_layout;

bool is_gridded(const PublishedState::Body& body) {
  return body.kind != BodyKind::rigid;
}

std::size_t encoded_size(const PublishedState& state) {
  std::size_t size = kHeaderSize;
  if (state.has_vat) size += kBlockHeaderSize + kOffsetSize;
  for (const PublishedState::Body& body : state.bodies) {
    size += kBlockHeaderSize;
    size += is_gridded(body) ? body.positions.size() * kGridPositionSize : kPoseSize;
  }
  return size;
}

void put_header(ByteWriter& out, const PublishedState& state, const FrameGrid& grid) {
  const FrameHeader& header = state.header;
  const int flags = (header.playing ? kPlayingFlag : 0) | (header.slow ? kSlowFlag : 0);
  out.put(kMagic);
  out.put(kVersion);
  out.put(kKeyFrame);
  out.put(static_cast<std::uint16_t>(flags));
  out.put(header.epoch);
  out.put(header.sequence);
  out.put(header.tick);
  out.put(header.time);
  out.put(header.published);
  out.put(std::uint32_t{0});  // a key frame has no references
  out.put(std::uint32_t{0});
  out.put(header.dropped);
  out.put(static_cast<std::uint32_t>(state.bodies.size() + (state.has_vat ? 1 : 0)));
  for (const double coordinate : grid.origin) out.put(coordinate);
  out.put(grid.quantum);
  out.put(header.real_time_factor);
  out.put(std::uint32_t{0});
}

void put_block_header(ByteWriter& out, std::uint32_t body, FrameBlock::Kind kind,
                      std::uint8_t encoding, std::size_t particles) {
  out.put(body);
  out.put(static_cast<std::uint8_t>(kind));
  out.put(encoding);
  out.put(std::uint16_t{0});
  out.put(static_cast<std::uint32_t>(particles));
}

std::uint16_t grid_coordinate(double position, double origin, double quantum) {
  const double steps = std::round((position - origin) / quantum);
  if (!(steps > 0)) return 0;  // a NaN too
  return static_cast<std::uint16_t>(std::min(steps, kMaxGridCoordinate));
}

void put_body(ByteWriter& out, const PublishedState::Body& body, const FrameGrid& grid) {
  const auto kind = static_cast<FrameBlock::Kind>(body.kind);
  if (!is_gridded(body)) {
    put_block_header(out, body.id, kind, kPoseEncoding, 0);
    for (const double coordinate : body.center_of_mass) out.put(coordinate);
    for (const float component : body.orientation) out.put(component);
    return;
  }
  put_block_header(out, body.id, kind, kGridEncoding, body.positions.size());
  for (const Vec3& position : body.positions) {
    out.put(grid_coordinate(position.x(), grid.origin[0], grid.quantum));
    out.put(grid_coordinate(position.y(), grid.origin[1], grid.quantum));
    out.put(grid_coordinate(position.z(), grid.origin[2], grid.quantum));
  }
}

}  // namespace

FrameGrid make_frame_grid(const Vec3& min, const Vec3& max, double max_error) {
  VAT_CHECK(min.allFinite() && max.allFinite() && (max - min).allFinite());
  constexpr double kFinest = 1e-12;  // [m]: keeps the quantum of an empty domain above zero
  const double widest = (max - min).maxCoeff();
  const double wanted = std::isfinite(max_error) ? 2 * max_error : 0;
  return {{min.x(), min.y(), min.z()}, std::max({wanted, widest / kMaxGridCoordinate, kFinest})};
}

std::vector<std::uint8_t> encode_key_frame(const PublishedState& state, const FrameGrid& grid) {
  VAT_CHECK(grid.quantum > 0 && std::isfinite(grid.quantum));
  ByteWriter out(encoded_size(state));
  put_header(out, state, grid);
  if (state.has_vat) {
    put_block_header(out, 0, FrameBlock::Kind::vat, kOffsetEncoding, 0);
    for (int axis = 0; axis < 3; ++axis) out.put(state.vat_offset[axis]);
  }
  for (const PublishedState::Body& body : state.bodies) put_body(out, body, grid);
  return out.take();
}

bool show_the_same(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
  VAT_CHECK(a.size() >= kHeaderSize && b.size() >= kHeaderSize);
  const auto is_same = [&](std::size_t begin, std::size_t end) {
    return std::equal(a.begin() + begin, a.begin() + end, b.begin() + begin);
  };
  return a.size() == b.size() && is_same(0, kSequenceOffset) &&
         is_same(kDroppedOffset + sizeof(std::uint32_t), kRealTimeFactorOffset) &&
         is_same(kHeaderSize, a.size());
}

void patch_client(std::span<std::uint8_t> frame, std::uint32_t sequence, std::uint32_t dropped) {
  VAT_CHECK(frame.size() >= kHeaderSize);
  store(frame, kSequenceOffset, sequence);
  store(frame, kDroppedOffset, dropped);
}

}  // namespace vat
