#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/simulation/simulation.h"

namespace vat {

/// The header fields of FRAMES.md, that do not follow from how a frame is coded.
struct FrameHeader {
  bool playing = false;
  bool slow = false;
  std::uint32_t epoch = 0;
  std::uint32_t number = 0;  ///< counts the session's frames that show something new, from 1
  std::uint8_t stride = 1;   ///< who gets this frame gets every stride-th number
  std::uint64_t tick = 0;
  double time = 0;       ///< [s]
  double published = 0;  ///< server's clock [s since 1970]
  float real_time_factor = 0;
};

/// What may be sent of a particle beside its place. Liquids have all, deformable bodies speed and
/// acceleration, rigid bodies none.
enum class FrameAttribute : std::uint8_t { speed = 0, density = 1, pressure = 2, acceleration = 3 };
inline constexpr std::size_t kFrameAttributes = 4;
/// One entry an attribute, in their order.
template <class T>
using ByAttribute = std::array<T, kFrameAttributes>;

/// What a session publishes at a tick: a copy that encoders may read at any time, from any thread.
struct PublishedState {
  struct Body {
    BodyId id = 0;
    BodyKind kind = BodyKind::liquid;
    std::vector<Vec3> positions;             ///< [m] liquid and deformable bodies
    std::array<double, 3> center_of_mass{};  ///< [m] rigid bodies
    std::array<double, 4> orientation{1, 0, 0, 0};
    double bounding_radius = 0;          ///< [m] rigid bodies: of all particles, about the centre
    std::vector<std::uint32_t> numbers;  ///< of the particles, rising; empty: 0, 1, 2, ...
    /// [m/s], [kg/m^3], [Pa], [m/s^2]: empty where the body has none, or nobody asked for them.
    ByAttribute<std::vector<float>> attributes;

    bool operator==(const Body&) const = default;
  };
  FrameHeader header;
  bool has_vat = false;
  Vec3 vat_offset = Vec3::Zero();
  std::vector<Body> bodies;
};

/// Copies what a simulation shows, again and again, into memory that is used again. Used by one
/// thread at a time.
class StatePublisher {
 public:
  /// Replaces all of `state`, with the attributes that are `wanted`; of the header it knows the
  /// time. Density and pressure cost a search for neighbours. Allocates nothing where `state` has
  /// had as much in it before; but for those two.
  void publish(const Simulation& simulation, const ByAttribute<bool>& wanted,
               PublishedState& state);

  /// An acceleration is what the velocity has changed by since this, over `seconds` that are to
  /// pass: of all that acts, whatever the steps do with it. 0 of particles that have come since.
  void remember(const Simulation& simulation, Real seconds);
  /// From now on it is 0, until velocities are remembered anew.
  void forget();

 private:
  struct Remembered {
    BodyId id = 0;
    std::vector<Vec3> velocities;
    std::vector<Index> numbers;  // empty: 0, 1, 2, ...
  };
  void put_accelerations(const BodyView& view, std::vector<float>& accelerations) const;

  std::vector<Remembered> remembered_;
  Real seconds_ = 0;  // 0: none are
  std::vector<BodyView> views_;
  LiquidFields fields_;
};

/// The same, once.
PublishedState publish(const Simulation& simulation, const ByAttribute<bool>& wanted = {});

}  // namespace vat
