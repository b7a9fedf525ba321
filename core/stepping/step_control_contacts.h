#pragma once

#include <limits>
#include <vector>

#include "core/evaluation/force_model.h"
#include "core/guard/guard.h"
#include "core/numerics/stable_step.h"

namespace vat {

/// The contacts of a particle or of a rigid body, walls included, that act now or may soon.
///
/// Until the first of them acts a step need not resolve them: it may reach up to there. Where they
/// act it is to be stable, and to resolve to the scene's tolerance the oscillation that they start:
/// of amplitude speed / omega, and in full from kFullAmplitude of the threshold on, below in
/// proportion. So a pile at rest needs only stability.
struct ContactPrediction {
  /// sum of k n n^T and of b n n^T, by Young's inequality in the share of the pair's motion that
  /// makes the bound least: (a - b)^2 <= (1 + s) a^2 + (1 + 1/s) b^2 [N/m], [N s/m].
  Mat3 stiffness = Mat3::Zero();
  Mat3 damping = Mat3::Zero();
  Real time = std::numeric_limits<Real>::infinity();       ///< to the first; 0: one acts [s]
  Real speed = 0;                                          ///< along the normal, the greatest [m/s]
  Real threshold = std::numeric_limits<Real>::infinity();  ///< the least [m]

  void add(const ContactPrediction& other);
  bool is_empty() const { return time == std::numeric_limits<Real>::infinity(); }
};
inline constexpr Real kFullAmplitude = 0.01;

/// Scratch of find_contact_steps().
struct ContactScratch {
  std::vector<ContactPrediction> prediction;  ///< by rigid particle
  std::vector<Real> inverse_mass;             ///< of the motion that a force on the particle starts
};

/// What bounds the steps of a model whatever its state.
struct StepBounds {
  std::vector<Oscillation> own;  ///< by free particle: of its springs, or of its liquid
  std::vector<Real> own_step;    ///< by free particle: that is stable for them [s]
  Real scene_step = 0;           ///< that resolves the central field, and with which bodies are
                                 ///< stable in a liquid [s]; infinite without either
};

/// How far ahead contacts are looked for.
struct ContactHorizon {
  Real longest = 0;  ///< step [s]
  Real reach = 0;    ///< how far any two particles may approach each other within that [m]
};

/// Lowers the steps by free particle and by rigid body to those that their contacts, together with
/// the other forces on the free particles, allow. Positions and cells must be those of the present
/// state.
void find_contact_steps(const ForceModel& force_model, const Configuration& at, Real time,
                        const ContactHorizon& ahead, const StepBounds& bounds,
                        ContactScratch& scratch, std::vector<Real>& particle_step,
                        std::vector<Real>& rigid_step);

/// The stable step of the scene's integrator, with a margin; infinite where it has none.
Real safe_step(const Numerics& numerics, const Oscillation& oscillation);

}  // namespace vat
