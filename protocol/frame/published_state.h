#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/simulation/simulation.h"

namespace vat {

/// The header fields of FRAMES.md that do not depend on the coding of a frame.
struct FrameHeader {
  bool playing = false;
  bool slow = false;
  std::uint32_t epoch = 0;
  std::uint32_t number = 0;  ///< counts the session's frames with new content, from 1
  std::uint8_t stride = 1;   ///< the receiver gets every stride-th frame number
  std::uint64_t tick = 0;
  double time = 0;       ///< [s]
  double published = 0;  ///< server's clock [s since 1970]
  float real_time_factor = 0;
};

/// Optional attributes of particles. Liquids have all four, deformable bodies have speed and
/// acceleration, rigid bodies have no attributes.
enum class FrameAttribute : std::uint8_t { speed = 0, density = 1, pressure = 2, acceleration = 3 };
inline constexpr std::size_t kFrameAttributes = 4;
/// One element per attribute, in the order of FrameAttribute.
template <class T>
using ByAttribute = std::array<T, kFrameAttributes>;

/// A copy of the session's state at a tick, for encoders. Immutable after its publication, so any
/// thread can read it.
struct PublishedState {
  struct Body {
    BodyId id = 0;
    BodyKind kind = BodyKind::liquid;
    std::vector<Vec3> positions;             ///< [m] liquid and deformable bodies
    std::array<double, 3> center_of_mass{};  ///< [m] rigid bodies
    std::array<double, 4> orientation{1, 0, 0, 0};
    double bounding_radius = 0;  ///< [m] rigid bodies: of all particles, about the centre of mass
    std::vector<std::uint32_t> numbers;  ///< particle numbers, ascending; empty: 0, 1, 2, ...
    /// [m/s], [kg/m^3], [Pa], [m/s^2]. Empty if not requested or not available for the body.
    ByAttribute<std::vector<float>> attributes;

    bool operator==(const Body&) const = default;
  };
  FrameHeader header;
  bool has_vat = false;
  Vec3 vat_offset = Vec3::Zero();
  std::vector<Body> bodies;
};

/// Copies the visible state of a simulation into reused memory. Not thread-safe.
class StatePublisher {
 public:
  /// Replaces `state`, with the `wanted` attributes. Sets only the time in the header. Density and
  /// pressure require a neighbour search. Does not allocate if `state` has sufficient capacity,
  /// except for density and pressure.
  void publish(const Simulation& simulation, const ByAttribute<bool>& wanted,
               PublishedState& state);

  /// Stores the present velocities. Accelerations are later computed as the change of velocity
  /// since this call / `seconds`, and are 0 for particles added since. `seconds` is the time until
  /// the next publication.
  void remember(const Simulation& simulation, Real seconds);
  /// Discards the stored velocities: accelerations are 0 until the next remember().
  void forget();

 private:
  struct Remembered {
    BodyId id = 0;
    std::vector<Vec3> velocities;
    std::vector<Index> numbers;  // empty: 0, 1, 2, ...
  };
  void put_accelerations(const BodyView& view, std::vector<float>& accelerations) const;

  std::vector<Remembered> remembered_;
  Real seconds_ = 0;  // 0: no velocities are stored
  std::vector<BodyView> views_;
  LiquidFields fields_;
};

/// Returns a new copy of the simulation's state; see StatePublisher::publish().
PublishedState publish(const Simulation& simulation, const ByAttribute<bool>& wanted = {});

}  // namespace vat
