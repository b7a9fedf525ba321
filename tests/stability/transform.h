#pragma once

#include "core/simulation/simulation.h"

/// Transformed scenes. Bodies must consist of explicit particles.
namespace vat::stability {

Scene rotated(Scene scene, const Quat& rotation);          ///< about the origin; without a vat
Scene translated(Scene scene, const Vec3& offset);         ///< including its vat
Scene in_moving_frame(Scene scene, const Vec3& velocity);  ///< all bodies move; without a vat
Scene mirrored(Scene scene);                               ///< maps x to -x
Scene renumbered(Scene scene);                             ///< reverses bodies and particles

}  // namespace vat::stability
