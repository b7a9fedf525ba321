#pragma once

#include <limits>
#include <vector>

#include "core/scene/stable_step.h"
#include "core/step/force_model.h"
#include "core/step/guard.h"

namespace vat {

/// The contacts of a particle or of a rigid body, walls included, that act now or may soon.
///
/// Until the first of them acts a step need not resolve them: it may reach up to there. Where they
/// act it is to be stable, and to resolve to the scene's tolerance the oscillation that they start:
/// of amplitude speed / omega, and in full from kFullAmplitude of the threshold on, below in
/// proportion. So a pile at rest needs only stability.
struct ContactOutlook {
  Oscillation bound;                                       ///< by Gershgorin's theorem
  Real time = std::numeric_limits<Real>::infinity();       ///< to the first; 0: one acts [s]
  Real speed = 0;                                          ///< along the normal, the greatest [m/s]
  Real threshold = std::numeric_limits<Real>::infinity();  ///< the least [m]

  void add(const ContactOutlook& other);
};
inline constexpr Real kFullAmplitude = 0.01;

/// Scratch of find_contact_steps().
struct ContactScratch {
  std::vector<ContactOutlook> outlook;  ///< by particle
  std::vector<Real> inverse_mass;       ///< of the motion that a force on the particle starts
};

/// Lowers the steps by free particle and by rigid body to those that their contacts allow.
/// Positions and cells must be those of the present state. `reach` [m] is how far any two particles
/// may approach each other within `longest` [s].
void find_contact_steps(const ForceModel& force_model, const Configuration& at, Real time,
                        Real longest, Real reach, ContactScratch& scratch,
                        std::vector<Real>& particle_step, std::vector<Real>& rigid_step);

/// The stable step of the scene's integrator, with a margin; infinite where it has none.
Real safe_step(const Numerics& numerics, const Oscillation& oscillation);

}  // namespace vat
