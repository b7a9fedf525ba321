#pragma once

#include "tests/validation/run.h"

/// Pools with a ball: the first body is the liquid, a sampled box, the second the ball.
namespace vat::validation {

/// The same as explicit particles, without those nearer than `radius` to the ball's position.
void clear_around_ball(Scene& scene, Real radius);

/// Depth of the ball's lowest point under the level of the volumes, over its diameter, in a vat of
/// that ground area [m^2], where the liquid and what the ball displaces have 1000 kg/m^3.
Real draft(const Run& run, Real radius, Real area);

}  // namespace vat::validation
