#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/simulation/simulation.h"

namespace vat {

/// Header fields of a frame (FRAMES.md) that do not depend on the encoding.
struct FrameHeader {
  bool playing = false;
  bool slow = false;
  /// Identifies the description (PROTOCOL.md, "Description") to which the frame belongs.
  std::uint32_t epoch = 0;
  std::uint32_t number = 0;  ///< counts the session's frames with changes, from 1
  std::uint8_t stride = 1;   ///< the client receives every stride-th number
  std::uint64_t tick = 0;
  double time = 0;       ///< [s]
  double published = 0;  ///< time of publication [s since 1970]
  float real_time_factor = 0;
};

/// Optional attributes of particles. Liquids have all four attributes. Deformable bodies have speed
/// and acceleration. Rigid bodies have no attributes.
enum class FrameAttribute : std::uint8_t { speed = 0, density = 1, pressure = 2, acceleration = 3 };
inline constexpr std::size_t kFrameAttributes = 4;
/// Array with one element per attribute, in the order of FrameAttribute.
template <class T>
using ByAttribute = std::array<T, kFrameAttributes>;

/// Copy of a session's state at a tick, for encoders. The copy is immutable after publication, so
/// that any thread can read it.
struct PublishedState {
  struct Body {
    BodyId id = 0;
    BodyKind kind = BodyKind::liquid;
    std::vector<Vec3> positions;             ///< [m], liquid and deformable bodies
    std::array<double, 3> center_of_mass{};  ///< [m], rigid bodies
    std::array<double, 4> orientation{1, 0, 0, 0};
    /// Rigid bodies: greatest distance of a particle from the centre of mass [m].
    double bounding_radius = 0;
    std::vector<std::uint32_t> numbers;  ///< particle numbers, ascending; empty: 0, 1, 2, ...
    /// Attributes [m/s], [kg/m^3], [Pa], [m/s^2]. An attribute is empty if it was not requested or
    /// is not available for the body.
    ByAttribute<std::vector<float>> attributes;

    bool operator==(const Body&) const = default;
  };
  FrameHeader header;
  bool has_vat = false;
  Vec3 vat_offset = Vec3::Zero();
  std::vector<Body> bodies;
};

/// Copier of a simulation's visible state into reused memory. Not thread-safe.
class StatePublisher {
 public:
  /// Writes the visible state, with the `wanted` attributes. Of the header, writes only the time.
  /// Density and pressure require a neighbour search. Does not allocate if `state` has sufficient
  /// capacity, except for density and pressure.
  void publish(const Simulation& simulation, const ByAttribute<bool>& wanted,
               PublishedState& state);

  /// Stores the present velocities. Later publications compute accelerations as the change of
  /// velocity since this call, divided by `seconds`. Particles that were added after this call have
  /// the acceleration 0. `seconds` is the time until the next publication.
  void remember(const Simulation& simulation, Real seconds);
  /// Discards the stored velocities. Accelerations are 0 until the next call of remember().
  void forget();

 private:
  struct Remembered {
    BodyId id = 0;
    std::vector<Vec3> velocities;
    std::vector<Index> numbers;  // particle numbers; empty: 0, 1, 2, ...
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
