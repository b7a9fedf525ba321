#pragma once

#include "core/simulation/simulation.h"

namespace vat {

/// Returns the default position error of frames [m]: 1/64 of the particle spacing of the finest
/// liquid or deformable body. Returns 0, the finest grid, if there is no such body.
double default_max_error(const Simulation& simulation);

}  // namespace vat
