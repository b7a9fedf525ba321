#pragma once

#include "core/simulation/simulation.h"

namespace vat::bench {

/// How many particles a liquid particle has closer than its support radius, itself left out: the
/// mean over all liquid particles. Particles of solids, and mirror images in the vat's walls, count
/// where they take part in a liquid's density. Not a number without liquid, and in periodic worlds,
/// where it is not counted.
Real mean_neighbours(const Simulation& simulation);

}  // namespace vat::bench
