#pragma once

#include <vector>

#include "core/stage/scratch.h"
#include "core/types.h"

namespace vat {

/// The data of a liquid particle for surface tension; see core/liquid/surface/surface_tension.h.
struct SurfaceRecord {
  Vec3 gradient;           ///< g [1/m]
  Real kernel_deficiency;  ///< max(0, 1 - s)
};

/// Sums over one block of slots, for the balance of the curvature forces. Moments are about the
/// origin.
struct SurfaceSum {
  Vec3 force = Vec3::Zero();          ///< [N]
  Vec3 torque = Vec3::Zero();         ///< [N m]
  Real share = 0;                     ///< sum of weights: surface tension times area [J]
  Vec3 moment = Vec3::Zero();         ///< sum of weights times x
  Mat3 second_moment = Mat3::Zero();  ///< sum of weights times x x^T

  SurfaceSum& operator+=(const SurfaceSum& other) {
    force += other.force;
    torque += other.torque;
    share += other.share;
    moment += other.moment;
    second_moment += other.second_moment;
    return *this;
  }
};

/// Buffers of surface tension, by liquid slot.
struct SurfaceScratch {
  static constexpr Method kMethod = Method::surface;

  std::vector<SurfaceRecord> surface;
  std::vector<Vec3> surface_normals;  ///< inward unit vectors; zero away from the surface
  std::vector<Vec3> surface_forces;   ///< curvature forces [N]
  std::vector<SurfaceSum> surface_sums;
};

}  // namespace vat
