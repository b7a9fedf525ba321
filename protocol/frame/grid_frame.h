#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/published/published_state.h"

namespace vat {

/// Grid of encoded positions. A coordinate is origin + n * quantum with 0 <= n <= 65 535.
struct FrameGrid {
  std::array<double, 3> origin{};  ///< [m]
  double quantum = 0;              ///< [m], finite and above 0

  bool operator==(const FrameGrid&) const = default;
};
/// Returns the coarsest grid with an error of at most `max_error` [m] per axis. The quantum is 2 *
/// max_error, or larger if the box [min, max] requires a larger quantum. If `max_error` is not
/// above 0, returns the finest grid that covers the box. The corners of the box [m] must be finite.
FrameGrid make_frame_grid(const Vec3& min, const Vec3& max, double max_error);

/// Quantisation of the positions and attributes of a frame.
struct FrameScale {
  FrameGrid grid;
  ByAttribute<double> attribute_quanta{};  ///< twice the maximum error; 0: attribute omitted

  bool operator==(const FrameScale&) const = default;
};

/// Greatest level of detail. Level d contains the layers 0 to d, see detail_layer().
inline constexpr std::uint8_t kFullDetail = 3;
/// Returns the layer of a particle number. Layers 0 and 1 each contain an eighth of a body's
/// particles, layer 2 a quarter, and layer 3 half.
std::uint8_t detail_layer(std::uint32_t number);

/// An axis-aligned box [m].
struct FrameRegion {
  Vec3 min = Vec3::Zero();
  Vec3 max = Vec3::Zero();

  bool operator==(const FrameRegion&) const = default;
};

/// Selection of the particles of liquid and deformable bodies in a frame.
struct FrameSelection {
  std::uint8_t detail = kFullDetail;
  std::optional<FrameRegion> region;  ///< only particles inside or on the boundary; absent: all

  bool operator==(const FrameSelection&) const = default;
};

/// Quantised data of one body. The encoder and all decoders store the same integers.
struct GridBlock {
  enum class Kind : std::uint8_t { liquid = 0, deformable = 1, rigid = 2, vat = 3 };

  std::uint32_t body = 0;  ///< id of the body; 0: the vat
  Kind kind = Kind::liquid;
  // Members of liquid and deformable bodies.
  std::vector<std::uint32_t> numbers;    ///< particle numbers, ascending; empty: 0, 1, 2, ...
  std::vector<std::uint16_t> positions;  ///< x, y, z of each particle
  ByAttribute<std::vector<std::int32_t>> attributes;
  // Rigid bodies: centre of mass relative to the grid's origin [1/2 quantum]. Vat: displacement
  // since time 0 [quantum].
  std::array<std::int32_t, 3> place{};
  /// Rigid bodies: unit quaternion w, x, y, z, multiplied by 2^orientation_bits and rounded.
  std::array<std::int32_t, 4> orientation{};
  std::uint8_t orientation_bits = 0;

  bool has_particles() const { return kind == Kind::liquid || kind == Kind::deformable; }
  std::size_t particle_count() const { return positions.size() / 3; }
  std::uint32_t number(std::size_t i) const {
    return numbers.empty() ? static_cast<std::uint32_t>(i) : numbers[i];
  }
  bool operator==(const GridBlock&) const = default;
};

/// A quantised frame. The block of the vat is the first. The other blocks are in the order of the
/// bodies in the session's description.
struct GridFrame {
  FrameHeader header;
  FrameScale scale;
  std::uint8_t detail = kFullDetail;
  bool has_region = false;
  std::vector<GridBlock> blocks;
};

/// Clears `numbers` if the elements are 0, 1, ..., count - 1. `numbers` must be ascending.
void drop_plain_numbers(std::size_t count, std::vector<std::uint32_t>& numbers);

/// Writes the quantised state to `frame` and reuses the memory of `frame`. The error of each
/// coordinate and attribute is at most half a quantum, also for the particles of rigid bodies.
/// Positions outside the grid are moved to the edge of the grid. Attributes are limited to 2^20
/// quanta in magnitude.
void make_grid_frame(const PublishedState& state, const FrameScale& scale, GridFrame& frame);
/// Writes only the particles of this level of detail, as select_particles(). Takes less time, which
/// is in proportion to the number of these particles.
void make_grid_frame(const PublishedState& state, const FrameScale& scale, std::uint8_t detail,
                     GridFrame& frame);
/// Writes the selected part of the frame `all` to `part`, and reuses the memory of `part`. The
/// arguments must be different objects.
void select_particles(const GridFrame& all, const FrameSelection& selection, GridFrame& part);

/// Returns whether two frames show the same content. Number, stride, tick, time, publication time
/// and real-time factor can differ.
bool show_the_same(const GridFrame& a, const GridFrame& b);

/// Returns a rigid body's centre of mass or the vat's displacement [m].
std::array<double, 3> place_of(const GridFrame& frame, const GridBlock& block);
/// Returns a rigid body's orientation as a unit quaternion w, x, y, z.
std::array<double, 4> orientation_of(const GridBlock& block);

}  // namespace vat
