#pragma once

#include <limits>
#include <vector>

#include "core/evaluation/force_model.h"
#include "core/guard/guard.h"
#include "core/numerics/stable_step.h"

namespace vat {

/// The contacts of a particle or a rigid body that act or may soon act, including contacts with
/// walls.
///
/// A step that ends before the first contact acts need not resolve the contacts. Acting contacts
/// must be stable, and their oscillation must be resolved to the tolerance of the scene. The
/// amplitude of this oscillation is speed / omega. The tolerance applies fully to amplitudes of at
/// least kFullAmplitude times the threshold, and proportionally to smaller amplitudes. In a pile at
/// rest, only stability therefore limits the step.
struct ContactPrediction {
  /// Sums of k n n^T [N/m] and of b n n^T [N s/m] over the contacts. The weights of the two
  /// particles of a pair follow from Young's inequality, (a - b)^2 <= (1 + s) a^2 + (1 + 1/s) b^2,
  /// with the s that minimises the bound.
  Mat3 stiffness = Mat3::Zero();
  Mat3 damping = Mat3::Zero();
  /// Time to the first contact; 0 if a contact acts [s].
  Real time = std::numeric_limits<Real>::infinity();
  Real speed = 0;                                          ///< maximum speed along the normal [m/s]
  Real threshold = std::numeric_limits<Real>::infinity();  ///< minimum threshold [m]

  void add(const ContactPrediction& other);
  bool is_empty() const { return time == std::numeric_limits<Real>::infinity(); }
};
inline constexpr Real kFullAmplitude = 0.01;

/// Returns the phase omega dt of a contact that a step resolves to the tolerance.
Real contact_phase(const Numerics& numerics);

/// Buffers of find_contact_steps().
struct ContactScratch {
  std::vector<ContactPrediction> prediction;  ///< by rigid particle
  std::vector<Real> inverse_mass;             ///< for forces on the particle [1/kg]
};

/// Bounds of the steps of a model that are valid for all states.
struct StepBounds {
  std::vector<Oscillation> own;  ///< by free particle: bound by springs or liquid
  std::vector<Real> own_step;    ///< by free particle: stable step for `own` [s]
  /// The step that resolves the central field and is stable for bodies in a liquid; infinite
  /// without a central field and such bodies [s].
  Real scene_step = 0;
};

/// The range in which contacts are predicted.
struct ContactHorizon {
  Real longest = 0;  ///< longest step [s]
  Real reach = 0;    ///< maximum approach of two particles in this step [m]
};

/// Reduces the steps of free particles and rigid bodies to the steps that their contacts allow,
/// together with the other forces on free particles. Positions and cells must be those of the
/// present state.
void find_contact_steps(const ForceModel& force_model, const Configuration& at, Real time,
                        const ContactHorizon& ahead, const StepBounds& bounds,
                        ContactScratch& scratch, std::vector<Real>& particle_step,
                        std::vector<Real>& rigid_step);

/// Returns the stable step of the scene's integrator for `oscillation`, reduced by a margin [s];
/// infinite without a stability limit.
Real safe_step(const Numerics& numerics, const Oscillation& oscillation);

}  // namespace vat
