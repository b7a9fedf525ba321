#pragma once

#include "tests/validation/case.h"

namespace vat::validation {

/// The equilibrium of a relaxed scene.
struct Equilibrium {
  Scene scene;        ///< the nodes at rest, without velocities
  Real residual = 0;  ///< maximum force on a free node [N]
  Row origin;         ///< seconds and state hash of the runs
};

/// Moves the one deformable body of a scene, given as particles, to rest. The run restarts with all
/// nodes at rest each time the kinetic energy decreases, which removes energy from every mode. Ends
/// when no force on a free node exceeds `residual` [N]. Throws after 10^6 steps.
Equilibrium relax(Scene scene, Real residual, Sheet& sheet);

}  // namespace vat::validation
