#pragma once

#include "tests/validation/run.h"

/// Pools with a ball. The first body is the liquid, a sampled box, and the second the ball.
namespace vat::validation {

/// Replaces the liquid by explicit particles, without those closer than `radius` to the ball's
/// position.
void clear_around_ball(Scene& scene, Real radius);

/// Returns the depth of the ball's lowest point below the water level, divided by its diameter. The
/// vat has the ground area `area` [m^2], and the level follows from the volumes at 1000 kg/m^3.
Real draft(const Run& run, Real radius, Real area);

}  // namespace vat::validation
