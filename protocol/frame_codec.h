#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/simulation.h"
#include "core/support/result.h"

namespace vat {

/// The header fields of PROTOCOL.md, "Frames"; block_count, magic, version and type are implied.
struct FrameHeader {
  bool playing = false;
  bool slow = false;
  std::uint32_t epoch = 0;
  std::uint32_t sequence = 0;
  std::uint64_t tick = 0;
  double time = 0;
  double published = 0;
  std::uint32_t dropped = 0;
  std::array<double, 3> origin{};
  double quantum = 0;
  float real_time_factor = 0;
};

struct FrameBlock {
  enum class Kind : std::uint8_t { liquid = 0, deformable = 1, rigid = 2, vat = 3 };
  std::uint32_t body = 0;
  Kind kind = Kind::liquid;
  std::vector<std::uint16_t> grid_positions;     ///< 3 n, liquid and deformable bodies
  std::array<double, 3> position{};              ///< rigid: centre of mass; vat: displacement
  std::array<float, 4> orientation{1, 0, 0, 0};  ///< rigid
};

struct Frame {
  FrameHeader header;
  std::vector<FrameBlock> blocks;
};

/// The grid on which positions are sent: covers [min, max] with at most 65 535 steps per axis.
struct FrameGrid {
  std::array<double, 3> origin{};
  double quantum = 0;  ///< [m] finite and above 0
};
/// The coarsest grid that keeps `max_error` [m] per axis: quantum = 2 * max_error, or more where
/// [min, max] does not fit. A `max_error` that is not above 0 asks for the finest grid that covers
/// the domain. The corners must be finite.
FrameGrid make_frame_grid(const Vec3& min, const Vec3& max, double max_error);

/// What a session publishes at a tick: a copy that encoders may read at any time, from any thread.
struct PublishedState {
  struct Body {
    BodyId id;
    BodyKind kind;
    std::vector<Vec3> positions;             ///< liquid and deformable bodies
    std::array<double, 3> center_of_mass{};  ///< rigid bodies
    std::array<float, 4> orientation{1, 0, 0, 0};
  };
  FrameHeader header;  ///< sequence, dropped and the grid are set when it is encoded
  bool has_vat = false;
  Vec3 vat_offset = Vec3::Zero();
  std::vector<Body> bodies;
};
PublishedState publish(const Simulation& simulation);

/// Bytes of a key frame. A position inside the grid is sent with an error of at most quantum / 2
/// per axis; one outside is moved to the nearest grid position. `sequence` and `dropped` may be
/// patched in afterwards by patch_client, so that clients share one encoding.
std::vector<std::uint8_t> encode_key_frame(const PublishedState& state, const FrameGrid& grid);
void patch_client(std::span<std::uint8_t> frame, std::uint32_t sequence, std::uint32_t dropped);

/// Whether two key frames differ in nothing but when they were made and for whom: all but tick,
/// time, publication, real-time factor, sequence and dropped.
bool show_the_same(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b);

/// The frame, only if every byte is as PROTOCOL.md says. Error codes: bad_magic, bad_version,
/// bad_type, bad_header, bad_block, truncated, extra_bytes.
Result<Frame> decode_frame(std::span<const std::uint8_t> bytes);

}  // namespace vat
