#pragma once

#include "core/simulation/simulation.h"

namespace vat {

/// [m] Greatest error of positions for a viewer who asks for none: a 64th of the distance between
/// the particles of the finest liquid or deformable body, which is twice the radius that the
/// description tells. 0, the finest grid, where there is no such body.
double default_max_error(const Simulation& simulation);

}  // namespace vat
