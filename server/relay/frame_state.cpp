#include "server/relay/frame_state.h"

#include <cmath>

namespace vat {
namespace {

BodyKind kind_of(GridBlock::Kind kind) {
  switch (kind) {
    case GridBlock::Kind::deformable:
      return BodyKind::deformable;
    case GridBlock::Kind::rigid:
      return BodyKind::rigid;
    case GridBlock::Kind::liquid:
    case GridBlock::Kind::vat:
      break;
  }
  return BodyKind::liquid;
}

void read_particles(const GridFrame& frame, const GridBlock& block, PublishedState::Body& body) {
  const auto& [origin, quantum] = frame.scale.grid;
  const std::size_t count = block.particle_count();
  body.numbers.assign(block.numbers.begin(), block.numbers.end());
  body.positions.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      body.positions[i][static_cast<Eigen::Index>(axis)] =
          origin[axis] + quantum * block.positions[3 * i + axis];
    }
  }
  for (std::size_t a = 0; a < kFrameAttributes; ++a) {
    body.attributes[a].clear();
    for (const std::int32_t value : block.attributes[a]) {
      body.attributes[a].push_back(static_cast<float>(value * frame.scale.attribute_quanta[a]));
    }
  }
}

void read_pose(const GridFrame& frame, const GridBlock& block, PublishedState::Body& body) {
  body.center_of_mass = place_of(frame, block);
  body.orientation = orientation_of(block);
  body.bounding_radius = std::ldexp(frame.scale.grid.quantum, block.orientation_bits) / 8;
}

}  // namespace

void read_frame_state(const GridFrame& frame, PublishedState& state) {
  state.header = frame.header;
  state.has_vat = false;
  std::size_t count = 0;
  for (const GridBlock& block : frame.blocks) {
    if (block.kind == GridBlock::Kind::vat) {
      const auto place = place_of(frame, block);
      state.has_vat = true;
      state.vat_offset = {place[0], place[1], place[2]};
      continue;
    }
    if (state.bodies.size() == count) state.bodies.emplace_back();
    PublishedState::Body& body = state.bodies[count++];
    body.id = block.body;
    body.kind = kind_of(block.kind);
    if (block.has_particles()) {
      read_particles(frame, block, body);
    } else {
      read_pose(frame, block, body);
    }
  }
  state.bodies.resize(count);
}

}  // namespace vat
