#pragma once

#include <string>
#include <vector>

#include "core/scene/sampling.h"
#include "core/scene/scene.h"

namespace vat {

/// A step length above which part of a scene is expected to become unstable.
struct StepLimit {
  std::string path;    ///< JSON pointer to what limits the step
  std::string reason;  ///< "... become unstable"
  Real step = 0;       ///< [s]; 0: no step is stable with this integrator
};

/// Greatest omega dt of an undamped oscillator: 2 for symplectic Euler and velocity Verlet, 2 sqrt
/// 2 for RK4, and 0 for explicit Euler and Heun, whose oscillations grow at any step.
Real undamped_limit(IntegratorId integrator);

/// The limits of the scene's springs (by body), contacts (by pair of materials in use), speed of
/// sound and viscosity (by liquid body), for its integrator. `samples` are the scene's bodies.
/// Bounds: springs omega^2 <= 2 max_i (sum_j k_ij) / m_i; one contact omega^2 = k / mu of the
/// lightest pair; sound c dt / h <= 0.96 and viscosity nu dt / h^2 <= 0.126 on a cubic lattice of
/// the corrected [MCG03] forces under velocity Verlet, scaled by undamped_limit().
std::vector<StepLimit> find_step_limits(const Scene& scene,
                                        const std::vector<SampledBody>& samples);

}  // namespace vat
