#pragma once

#include "tests/validation/case.h"

namespace vat::validation {

/// Where a relaxed scene came to rest.
struct Equilibrium {
  Scene scene;        ///< with the nodes where they rest, without velocities
  Real residual = 0;  ///< greatest force on a free node [N]
  Row origin;         ///< seconds and state hash of the runs
};

/// Moves the one deformable body of a scene, given as particles, to rest: the run begins anew with
/// all nodes at rest whenever the kinetic energy falls, which takes energy from every mode, damped
/// or not. Ends where no force on a free node is above `residual` [N]; throws where 10^6 steps were
/// not enough.
Equilibrium relax(Scene scene, Real residual, const Sheet& sheet);

}  // namespace vat::validation
