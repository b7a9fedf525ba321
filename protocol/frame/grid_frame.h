#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/frame/published_state.h"

namespace vat {

/// The grid on which positions are sent: covers [min, max] with at most 65 535 steps per axis.
struct FrameGrid {
  std::array<double, 3> origin{};
  double quantum = 0;  ///< [m] finite and above 0

  bool operator==(const FrameGrid&) const = default;
};
/// The coarsest grid that keeps `max_error` [m] per axis: quantum = 2 * max_error, or more where
/// [min, max] does not fit. A `max_error` that is not above 0 asks for the finest grid that covers
/// the domain. The corners must be finite.
FrameGrid make_frame_grid(const Vec3& min, const Vec3& max, double max_error);

/// The steps in which a frame's numbers are given.
struct FrameScale {
  FrameGrid grid;
  ByAttribute<double> attribute_quanta{};  ///< twice the greatest error; 0: not in the frame

  bool operator==(const FrameScale&) const = default;
};

/// Levels of detail: level d has the layers 0 to d.
inline constexpr std::uint8_t kFullDetail = 3;
/// The layer of a particle: 0 and 1 have an eighth of a body's particles each, 2 a quarter, 3 half.
std::uint8_t detail_layer(std::uint32_t number);

/// A box along the axes [m].
struct FrameRegion {
  Vec3 min = Vec3::Zero();
  Vec3 max = Vec3::Zero();

  bool operator==(const FrameRegion&) const = default;
};

/// Which particles of liquid and deformable bodies a frame has.
struct FrameSelection {
  std::uint8_t detail = kFullDetail;
  std::optional<FrameRegion> region;  ///< only what is inside or on it

  bool operator==(const FrameSelection&) const = default;

  bool is_all() const { return detail == kFullDetail && !region; }
};

/// A body's part of a frame in whole steps: what an encoder and its decoders hold alike.
struct GridBlock {
  enum class Kind : std::uint8_t { liquid = 0, deformable = 1, rigid = 2, vat = 3 };

  std::uint32_t body = 0;  ///< 0 for the vat
  Kind kind = Kind::liquid;
  // Liquid and deformable bodies.
  std::vector<std::uint32_t> numbers;    ///< of its particles, rising; empty: 0, 1, 2, ...
  std::vector<std::uint16_t> positions;  ///< x, y, z of each particle
  ByAttribute<std::vector<std::int32_t>> attributes;
  // Rigid bodies and the vat: in half quanta from the grid's origin, and in whole quanta from the
  // vat's place at time 0.
  std::array<std::int32_t, 3> place{};
  /// Rigid bodies: w, x, y, z, times 2^orientation_bits. Of a unit quaternion but for rounding.
  std::array<std::int32_t, 4> orientation{};
  std::uint8_t orientation_bits = 0;

  bool has_particles() const { return kind == Kind::liquid || kind == Kind::deformable; }
  std::size_t particle_count() const { return positions.size() / 3; }
  std::uint32_t number(std::size_t i) const {
    return numbers.empty() ? static_cast<std::uint32_t>(i) : numbers[i];
  }
  bool operator==(const GridBlock&) const = default;
};

/// A frame in whole steps. Its blocks are in the order of the description's bodies, the vat first.
struct GridFrame {
  FrameHeader header;
  FrameScale scale;
  std::uint8_t detail = kFullDetail;
  bool has_region = false;
  std::vector<GridBlock> blocks;
};

/// Drops the numbers of so many particles where they are 0, 1, 2, ...: they rise.
void drop_plain_numbers(std::size_t count, std::vector<std::uint32_t>& numbers);

/// The state on a grid: every particle and attribute is off by half a quantum at most, and a rigid
/// body's pose so that none of its particles is, per axis. What is outside the grid goes to its
/// edge, and attributes beyond 2^20 quanta to that. Reuses the memory of `frame`.
void make_grid_frame(const PublishedState& state, const FrameScale& scale, GridFrame& frame);
/// The part of a frame that a selection has. Reuses the memory of `part`, which is another frame.
void select_particles(const GridFrame& all, const FrameSelection& selection, GridFrame& part);

/// Whether two frames differ in nothing but when they were made: all but number, stride, tick,
/// time, publication and real-time factor.
bool show_the_same(const GridFrame& a, const GridFrame& b);

/// In metres: a rigid body's centre of mass, or the vat's displacement.
std::array<double, 3> place_of(const GridFrame& frame, const GridBlock& block);
/// Of a rigid body: w, x, y, z of a unit quaternion.
std::array<double, 4> orientation_of(const GridBlock& block);

}  // namespace vat
