#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/types.h"
#include "protocol/client/methods/methods.h"

namespace vat::client {

/// Visible state of a session at a tick, decoded from a frame (protocol/FRAMES.md). All spans refer
/// to memory of the client. They are valid until the function that receives the frame returns.
struct Frame {
  struct Body {
    std::uint32_t body = 0;
    std::string_view name = {};  ///< from the description
    BodyKind kind = BodyKind::liquid;
    /// Positions of the particles [m]. For a rigid body: all its particles in the description.
    std::span<const Vec3> positions = {};
    /// Numbers of the particles, ascending. Empty: 0, 1, 2, ...
    std::span<const std::uint32_t> numbers = {};
    std::span<const float> speed = {};     ///< [m/s]; empty if not requested, like the next three
    std::span<const float> density = {};   ///< [kg/m^3], liquids
    std::span<const float> pressure = {};  ///< [Pa], liquids
    std::span<const float> acceleration = {};       ///< [m/s^2]
    Vec3 center_of_mass = Vec3::Zero();             ///< [m], rigid bodies
    std::array<double, 4> orientation{1, 0, 0, 0};  ///< quaternion w, x, y, z of rigid bodies
  };

  std::uint32_t epoch = 0;   ///< as in the description to which the frame belongs
  std::uint32_t number = 0;  ///< counts the frames of the session
  std::uint64_t tick = 0;
  double time = 0;       ///< simulated time [s]
  double published = 0;  ///< time of publication [s since 1970]
  float real_time_factor = 0;
  bool playing = false;
  bool slow = false;                    ///< the server reduces the frames of this client
  std::uint8_t stride = 1;              ///< the client receives every stride-th number
  std::uint8_t detail = 3;              ///< 0 to 3, as in frames.subscribe
  double max_error = 0;                 ///< greatest error of a position on each axis [m]
  std::optional<Vec3> vat_offset = {};  ///< displacement of the vat since time 0 [m]
  std::span<const Body> bodies = {};    ///< in the order of the description
};

}  // namespace vat::client
