#pragma once

#include "core/simulation/simulation.h"

namespace vat::bench {

/// Returns the mean number of particles within the support radius of a liquid particle, without the
/// particle itself. Solid particles and mirror images at walls count if they take part in the
/// liquid's density. Not a number without liquid and in periodic worlds.
Real mean_neighbours(const Simulation& simulation);

}  // namespace vat::bench
