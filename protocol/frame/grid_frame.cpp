#include "protocol/frame/grid_frame.h"

#include <algorithm>
#include <cmath>

#include "protocol/frame/frame_layout.h"

namespace vat {
namespace {

using namespace frame_layout;

/// Rounds to the nearest integer in [least, greatest]. Returns `least` for NaN.
double nearest(double value, double least, double greatest) {
  const double rounded = std::round(value);
  if (!(rounded > least)) return least;
  return std::min(rounded, greatest);
}

std::uint16_t grid_coordinate(double position, double origin, double quantum) {
  return static_cast<std::uint16_t>(nearest((position - origin) / quantum, 0, kMaxGridCoordinate));
}

std::int32_t whole(double value, std::int32_t greatest) {
  return static_cast<std::int32_t>(nearest(value, -greatest, greatest));
}

/// Whether a particle is in frames of this level of detail, which have 2^detail eighths of them.
bool is_in_detail(std::uint32_t number, std::uint8_t detail) {
  std::uint32_t hash = number;
  hash = (hash ^ (hash >> 16)) * 0x7feb352dU;
  hash = (hash ^ (hash >> 15)) * 0x846ca68bU;
  const std::uint32_t eighth = (hash ^ (hash >> 16)) >> 29;
  return eighth < 1U << detail;
}

/// Writes the selected particles of a body; `selected(i)` is the index of the i-th of them.
template <class Selected>
void place_particles(const PublishedState::Body& body, std::size_t count, const Selected& selected,
                     const FrameScale& scale, GridBlock& block) {
  const auto& [origin, quantum] = scale.grid;
  block.positions.resize(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& position = body.positions[selected(i)];
    block.positions[3 * i] = grid_coordinate(position.x(), origin[0], quantum);
    block.positions[3 * i + 1] = grid_coordinate(position.y(), origin[1], quantum);
    block.positions[3 * i + 2] = grid_coordinate(position.z(), origin[2], quantum);
  }
  for (std::size_t a = 0; a < kFrameAttributes; ++a) {
    if (!has_attribute(block.kind, scale, a)) continue;
    VAT_CHECK(body.attributes[a].size() == body.positions.size());
    for (std::size_t i = 0; i < count; ++i) {
      const auto value = static_cast<double>(body.attributes[a][selected(i)]);
      block.attributes[a].push_back(whole(value / scale.attribute_quanta[a], kMaxAttribute));
    }
  }
}

/// Writes the particles of this level of detail.
void place_particles(const PublishedState::Body& body, std::uint8_t detail, const FrameScale& scale,
                     GridBlock& block) {
  const std::size_t count = body.positions.size();
  VAT_CHECK(body.numbers.empty() || body.numbers.size() == count);
  VAT_CHECK(std::ranges::adjacent_find(body.numbers, std::ranges::greater_equal{}) ==
            body.numbers.end());
  if (detail == kFullDetail) {
    block.numbers.assign(body.numbers.begin(), body.numbers.end());
    drop_plain_numbers(count, block.numbers);
    place_particles(
        body, count, [](std::size_t i) { return i; }, scale, block);
    return;
  }
  std::vector<std::uint32_t> selected(count);
  block.numbers.resize(count);
  std::size_t used = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t number = body.numbers.empty() ? i : body.numbers[i];
    selected[used] = i;
    block.numbers[used] = number;
    used += is_in_detail(number, detail) ? 1 : 0;  // without branches, which would be unpredictable
  }
  selected.resize(used);
  block.numbers.resize(used);
  drop_plain_numbers(used, block.numbers);
  place_particles(
      body, selected.size(), [&](std::size_t i) { return selected[i]; }, scale, block);
}

/// Returns the bits per component. The centre and the orientation each have half of the maximum
/// error quantum / 2. Rounding a component by half a step rotates the body by at most 2 steps.
/// Therefore 2^bits must be at least 2 radius / (quantum / 4).
std::uint8_t orientation_bits_for(double radius, double quantum) {
  std::uint8_t bits = kMinOrientationBits;
  while (bits < kMaxOrientationBits && std::ldexp(quantum, bits) < 8 * radius) ++bits;
  return bits;
}

void place_rigid(const PublishedState::Body& body, const FrameGrid& grid, GridBlock& block) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double steps = (body.center_of_mass[axis] - grid.origin[axis]) / (grid.quantum / 2);
    block.place[axis] = whole(steps, kMaxPlace);
  }
  block.orientation_bits = orientation_bits_for(body.bounding_radius, grid.quantum);
  const double one = std::ldexp(1.0, block.orientation_bits);
  for (std::size_t c = 0; c < 4; ++c) {
    block.orientation[c] = whole(body.orientation[c] * one, kMaxPlace);
  }
}

/// Clears a block for a body. Reuses its memory.
void begin_block(std::uint32_t body, GridBlock::Kind kind, GridBlock& block) {
  block.body = body;
  block.kind = kind;
  block.numbers.clear();
  block.positions.clear();
  for (auto& column : block.attributes) column.clear();
  block.place = {};
  block.orientation = {};
  block.orientation_bits = 0;
}

void place_vat(const Vec3& offset, double quantum, GridBlock& block) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    block.place[axis] = whole(offset[static_cast<Eigen::Index>(axis)] / quantum, kMaxPlace);
  }
}

/// The region in quanta of the grid.
struct GridRegion {
  std::array<double, 3> min;
  std::array<double, 3> max;

  GridRegion(const FrameRegion& region, const FrameGrid& grid) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<Eigen::Index>(axis);
      min[axis] = (region.min[a] - grid.origin[axis]) / grid.quantum;
      max[axis] = (region.max[a] - grid.origin[axis]) / grid.quantum;
    }
  }
  bool contains(const std::uint16_t* position) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (position[axis] < min[axis] || position[axis] > max[axis]) return false;
    }
    return true;
  }
};

void select_from(const GridBlock& all, std::uint8_t detail, const GridRegion* region,
                 GridBlock& part) {
  for (std::size_t i = 0; i < all.particle_count(); ++i) {
    const std::uint16_t* position = &all.positions[3 * i];
    if (!is_in_detail(all.number(i), detail)) continue;
    if (region != nullptr && !region->contains(position)) continue;
    part.numbers.push_back(all.number(i));
    part.positions.insert(part.positions.end(), position, position + 3);
    for (std::size_t a = 0; a < kFrameAttributes; ++a) {
      if (!all.attributes[a].empty()) part.attributes[a].push_back(all.attributes[a][i]);
    }
  }
  drop_plain_numbers(part.particle_count(), part.numbers);
}

}  // namespace

FrameGrid make_frame_grid(const Vec3& min, const Vec3& max, double max_error) {
  VAT_CHECK(min.allFinite() && max.allFinite() && (max - min).allFinite());
  constexpr double kFinest = 1e-12;  // [m] a positive quantum for an empty domain
  const double widest = (max - min).maxCoeff();
  const double wanted = std::isfinite(max_error) ? 2 * max_error : 0;
  return {{min.x(), min.y(), min.z()}, std::max({wanted, widest / kMaxGridCoordinate, kFinest})};
}

void drop_plain_numbers(std::size_t count, std::vector<std::uint32_t>& numbers) {
  if (!numbers.empty() && numbers.back() == count - 1) numbers.clear();
}

std::uint8_t detail_layer(std::uint32_t number) {
  std::uint8_t layer = 0;
  while (!is_in_detail(number, layer)) ++layer;
  return layer;
}

void make_grid_frame(const PublishedState& state, const FrameScale& scale, std::uint8_t detail,
                     GridFrame& frame) {
  VAT_CHECK(detail <= kFullDetail);
  VAT_CHECK(scale.grid.quantum > 0 && std::isfinite(scale.grid.quantum));
  frame.header = state.header;
  frame.scale = scale;
  frame.detail = detail;
  frame.has_region = false;
  const std::size_t vats = state.has_vat ? 1 : 0;
  frame.blocks.resize(vats + state.bodies.size());
  if (state.has_vat) {
    begin_block(0, GridBlock::Kind::vat, frame.blocks[0]);
    place_vat(state.vat_offset, scale.grid.quantum, frame.blocks[0]);
  }
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    const PublishedState::Body& body = state.bodies[b];
    GridBlock& block = frame.blocks[vats + b];
    begin_block(body.id, static_cast<GridBlock::Kind>(body.kind), block);
    if (block.has_particles()) {
      place_particles(body, detail, scale, block);
    } else {
      place_rigid(body, scale.grid, block);
    }
  }
}

void make_grid_frame(const PublishedState& state, const FrameScale& scale, GridFrame& frame) {
  make_grid_frame(state, scale, kFullDetail, frame);
}

void select_particles(const GridFrame& all, const FrameSelection& selection, GridFrame& part) {
  VAT_CHECK(&all != &part && selection.detail <= kFullDetail);
  part.header = all.header;
  part.scale = all.scale;
  part.detail = selection.detail;
  part.has_region = selection.region.has_value();
  part.blocks.resize(all.blocks.size());
  std::optional<GridRegion> region;
  if (selection.region) region.emplace(*selection.region, all.scale.grid);
  for (std::size_t b = 0; b < all.blocks.size(); ++b) {
    if (!all.blocks[b].has_particles()) {
      part.blocks[b] = all.blocks[b];
      continue;
    }
    begin_block(all.blocks[b].body, all.blocks[b].kind, part.blocks[b]);
    select_from(all.blocks[b], selection.detail, region ? &*region : nullptr, part.blocks[b]);
  }
}

bool show_the_same(const GridFrame& a, const GridFrame& b) {
  return a.header.epoch == b.header.epoch && a.header.playing == b.header.playing &&
         a.header.slow == b.header.slow && a.scale == b.scale && a.detail == b.detail &&
         a.has_region == b.has_region && a.blocks == b.blocks;
}

std::array<double, 3> place_of(const GridFrame& frame, const GridBlock& block) {
  const auto& [origin, quantum] = frame.scale.grid;
  const bool is_vat = block.kind == GridBlock::Kind::vat;
  std::array<double, 3> place{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    place[axis] =
        is_vat ? quantum * block.place[axis] : origin[axis] + quantum / 2 * block.place[axis];
  }
  return place;
}

std::array<double, 4> orientation_of(const GridBlock& block) {
  std::array<double, 4> result{};
  double square = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    result[c] = block.orientation[c];
    square += result[c] * result[c];
  }
  for (double& component : result) component /= std::sqrt(square);
  return result;
}

}  // namespace vat
