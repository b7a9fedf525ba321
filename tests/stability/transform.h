#pragma once

#include "core/simulation/simulation.h"

/// The same scene seen differently. Bodies must be of explicit particles.
namespace vat::stability {

Scene rotated(Scene scene, const Quat& rotation);          ///< about the origin; without a vat
Scene translated(Scene scene, const Vec3& offset);         ///< with its vat
Scene in_moving_frame(Scene scene, const Vec3& velocity);  ///< everything moves; without a vat
Scene mirrored(Scene scene);                               ///< x becomes -x
Scene renumbered(Scene scene);                             ///< bodies and particles in reverse

}  // namespace vat::stability
