#include "protocol/client/exchange/frame_receiver.h"

#include "protocol/frame/frame_layout.h"

namespace vat::client {
namespace {

constexpr bool is_same(BodyKind kind, GridBlock::Kind block) {
  return static_cast<int>(kind) == static_cast<int>(block);
}
static_assert(is_same(BodyKind::liquid, GridBlock::Kind::liquid) &&
              is_same(BodyKind::deformable, GridBlock::Kind::deformable) &&
              is_same(BodyKind::rigid, GridBlock::Kind::rigid));

void put_positions(const GridFrame& grid, const GridBlock& block, std::vector<Vec3>& positions) {
  const auto& [origin, quantum] = grid.scale.grid;
  positions.resize(block.particle_count());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      positions[i][static_cast<Eigen::Index>(axis)] =
          origin[axis] + quantum * block.positions[3 * i + axis];
    }
  }
}

std::span<const float> put_attribute(const GridFrame& grid, const GridBlock& block,
                                     FrameAttribute attribute,
                                     ByAttribute<std::vector<float>>& all) {
  const auto a = static_cast<std::size_t>(attribute);
  const std::vector<std::int32_t>& values = block.attributes[a];
  all[a].resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    all[a][i] = static_cast<float>(grid.scale.attribute_quanta[a] * values[i]);
  }
  return all[a];
}

}  // namespace

void FrameReceiver::restart() {
  decoder_ = FrameDecoder();
  waits_for_key_ = false;
}

void FrameReceiver::describe(const SessionDescription& description) {
  described_.clear();
  for (const BodyDescription& body : description.bodies) {
    Described& described = described_[body.body];
    described.name = body.name;
    if (body.kind != BodyKind::rigid || !body.local_positions) continue;
    const std::vector<double>& numbers = *body.local_positions;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
      described.local_positions.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    }
  }
}

FrameReceiver::Reception FrameReceiver::receive(std::span<const std::uint8_t> bytes) {
  const Result<const GridFrame*> decoded = decoder_.decode(bytes);
  if (!decoded) return refuse(bytes, decoded.errors().front());
  waits_for_key_ = false;
  fill(*decoded.value());
  return {.frame = &frame_, .number = frame_.number};
}

FrameReceiver::Reception FrameReceiver::refuse(std::span<const std::uint8_t> bytes,
                                               const Error& error) {
  const bool was_waiting = std::exchange(waits_for_key_, true);
  Reception refused;
  if (bytes.size() >= frame_layout::kHeaderSize) refused.number = frame_number(bytes);
  // The frames before the key frame lack references too.
  if (was_waiting && error.code == "missing_reference") return refused;
  refused.asks_for_key = true;
  refused.is_broken = was_waiting || refused.number == 0;
  refused.fault = "an invalid frame (" + error.code + "): " + error.message;
  return refused;
}

void FrameReceiver::fill(const GridFrame& grid) {
  const FrameHeader& header = grid.header;
  frame_ = Frame{.epoch = header.epoch,
                 .number = header.number,
                 .tick = header.tick,
                 .time = header.time,
                 .published = header.published,
                 .real_time_factor = header.real_time_factor,
                 .playing = header.playing,
                 .slow = header.slow,
                 .stride = header.stride,
                 .detail = grid.detail,
                 .max_error = grid.scale.grid.quantum / 2};
  rooms_.resize(grid.blocks.size());
  bodies_.clear();
  for (std::size_t i = 0; i < grid.blocks.size(); ++i) {
    const GridBlock& block = grid.blocks[i];
    if (block.kind == GridBlock::Kind::vat) {
      const std::array<double, 3> offset = place_of(grid, block);
      frame_.vat_offset = Vec3(offset[0], offset[1], offset[2]);
    } else {
      bodies_.push_back(make_body(grid, block, rooms_[i]));
    }
  }
  frame_.bodies = bodies_;
}

Frame::Body FrameReceiver::make_body(const GridFrame& grid, const GridBlock& block,
                                     Room& room) const {
  Frame::Body body{.body = block.body, .kind = static_cast<BodyKind>(block.kind)};
  const auto described = described_.find(block.body);
  const bool is_known = described != described_.end();
  if (is_known) body.name = described->second.name;
  if (block.has_particles()) {
    put_positions(grid, block, room.positions);
    body.numbers = block.numbers;
    body.speed = put_attribute(grid, block, FrameAttribute::speed, room.attributes);
    body.density = put_attribute(grid, block, FrameAttribute::density, room.attributes);
    body.pressure = put_attribute(grid, block, FrameAttribute::pressure, room.attributes);
    body.acceleration = put_attribute(grid, block, FrameAttribute::acceleration, room.attributes);
  } else {
    const std::array<double, 3> center = place_of(grid, block);
    body.center_of_mass = Vec3(center[0], center[1], center[2]);
    body.orientation = orientation_of(block);
    const auto& [w, x, y, z] = body.orientation;
    const Mat3 rotation = Quat(w, x, y, z).toRotationMatrix();
    room.positions.clear();
    if (is_known) {
      for (const Vec3& local : described->second.local_positions) {
        room.positions.push_back(body.center_of_mass + rotation * local);
      }
    }
  }
  body.positions = room.positions;
  return body;
}

}  // namespace vat::client
