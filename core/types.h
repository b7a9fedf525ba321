#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

namespace vat {

/// Scalar type of the state and of the time integration. All quantities are in SI units.
using Real = double;
using Vec3 = Eigen::Matrix<Real, 3, 1>;
using Mat3 = Eigen::Matrix<Real, 3, 3>;
/// Unit quaternion. Components are always written in the order (w, x, y, z).
using Quat = Eigen::Quaternion<Real>;
using Index = std::uint32_t;

/// Identifier of a body, unique within a simulation. Ids of removed bodies are not reused.
using BodyId = std::uint32_t;
inline constexpr Index kNoParticle = ~Index{0};  ///< value for "no particle"

}  // namespace vat
