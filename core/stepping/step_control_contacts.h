#pragma once

#include <limits>
#include <vector>

#include "core/evaluation/force_model.h"
#include "core/guard/guard.h"
#include "core/numerics/stable_step.h"

namespace vat {

/// The contacts of a particle or a rigid body, walls included, that act or may soon act.
///
/// Before the first of them acts, a step need not resolve them, and may extend to this time. Acting
/// contacts must be stable, and their oscillation must be resolved to the tolerance of the scene:
/// with its amplitude speed / omega, fully from kFullAmplitude of the threshold on, and
/// proportionally below. A pile at rest therefore only needs stability.
struct ContactPrediction {
  /// Sum of k n n^T and of b n n^T. By Young's inequality, (a - b)^2 <= (1 + s) a^2 + (1 + 1/s)
  /// b^2, with the share s of the pair's motion that minimises the bound [N/m], [N s/m].
  Mat3 stiffness = Mat3::Zero();
  Mat3 damping = Mat3::Zero();
  Real time = std::numeric_limits<Real>::infinity();  ///< to the first contact; 0: one acts [s]
  Real speed = 0;                                     ///< maximum along the normal [m/s]
  Real threshold = std::numeric_limits<Real>::infinity();  ///< minimum [m]

  void add(const ContactPrediction& other);
  bool is_empty() const { return time == std::numeric_limits<Real>::infinity(); }
};
inline constexpr Real kFullAmplitude = 0.01;

/// Buffers of find_contact_steps().
struct ContactScratch {
  std::vector<ContactPrediction> prediction;  ///< by rigid particle
  std::vector<Real> inverse_mass;             ///< of the motion that a force on the particle causes
};

/// Bounds of the steps of a model, for all states.
struct StepBounds {
  std::vector<Oscillation> own;  ///< by free particle: of its springs or its liquid
  std::vector<Real> own_step;    ///< by free particle: stable step for them [s]
  Real scene_step = 0;  ///< resolves the central field, and is stable for bodies in a liquid;
                        ///< infinite without both [s]
};

/// The time for which contacts are predicted.
struct ContactHorizon {
  Real longest = 0;  ///< longest step [s]
  Real reach = 0;    ///< maximum approach of two particles in this step [m]
};

/// Lowers the steps of free particles and rigid bodies to those that their contacts allow, together
/// with the other forces on free particles. Positions and cells must be those of the present state.
void find_contact_steps(const ForceModel& force_model, const Configuration& at, Real time,
                        const ContactHorizon& ahead, const StepBounds& bounds,
                        ContactScratch& scratch, std::vector<Real>& particle_step,
                        std::vector<Real>& rigid_step);

/// The stable step of the scene's integrator, with a margin; infinite if there is none.
Real safe_step(const Numerics& numerics, const Oscillation& oscillation);

}  // namespace vat
