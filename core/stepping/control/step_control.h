#pragma once

#include <array>
#include <vector>

#include "core/evaluation/force_model.h"
#include "core/guard/guard.h"
#include "core/stepping/control/step_control_contacts.h"

/// Functions that compute the step lengths that a state allows, and divide nominal steps into
/// parts.
namespace vat {

/// Returns the step bounds of `model`. The bounds are empty for fixed steps.
StepBounds find_step_bounds(const Model& model);
/// Returns `bounds`, updated for a model in which only the initial position of `body` and the
/// gravity on liquids have changed.
StepBounds step_bounds_of_moved(const Model& model, std::size_t body, StepBounds bounds);

/// Buffers for the step length of liquids.
struct LiquidStepScratch {
  std::vector<Vec3> velocities;              ///< by block of particles: sum [m/s]
  std::vector<std::array<Real, 2>> motions;  ///< by block: maximum squared speed, acceleration
  std::vector<Real> pressures;               ///< the highest ones [Pa]
};

/// Greatest rotation of a rigid body in one step [rad]. The guard allows 1.
inline constexpr Real kGreatestTurn = 0.5;

/// The maximum step lengths that a state allows [s]; infinite without a limit.
struct PresentSteps {
  std::vector<Real> particle;  ///< by free particle; forces of liquids excluded
  std::vector<Real> rigid;     ///< by rigid body
  Real liquid = 0;             ///< limit by the forces of liquids
  ContactScratch contacts;
  LiquidStepScratch liquid_scratch;

  Real least() const;
};

/// Fills `steps` for the present state, for local and adaptive control. The criteria are:
///
/// - Stability with a margin, for springs, contacts, sound and viscosity together; see
///   find_step_limits() and ContactPrediction.
/// - Resolution of contacts that act, or may act before the end of the step, to the tolerance.
/// - Travel at the present speed and force by at most half the distance that the guard allows. For
///   liquids, the limit is a quarter of the support radius relative to the mean motion of the
///   liquids.
/// - The pressure in an incompressible liquid, except for the highest 1 % of the values; see
///   pressed_lattice_omega2().
/// - Rotation of rigid bodies by at most half a radian.
/// - Stability of grabs, and resolution of the central field to the tolerance.
///
/// The usual criteria of SPH are 0.4 h_s / (c + |v|), 0.25 sqrt(h_s / |a|) and 0.125 h_s^2 / nu
/// with h_s = h / 2 (J. J. Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992) 543; J. P. Morris, P.
/// J. Fox, Y. Zhu, J. Comput. Phys. 136 (1997) 214). Steps by these criteria are a quarter of the
/// stable step, and independent of the tolerance. The criterion for sound is therefore only
/// stability here; the accuracy follows from the estimate of MotionProbe.
///
/// `longest` is the longest step of interest [s]. The function also sorts the cells of the
/// workspace.
void find_present_steps(const ForceModel& force_model, State& state, Real time, Real longest,
                        const StepBounds& bounds, const GuardBounds& guard, PresentSteps& steps);

/// Returns the longest whole step for local control [s]. The limits are the prediction of contacts,
/// and grabs, the central field and coupled liquids, which have no separate level. In this step,
/// two particles farther apart than twice Model::contact_reach do not come into contact.
Real greatest_base_step(const ForceModel& force_model, const State& state, const StepBounds& bounds,
                        const GuardBounds& guard, LiquidStepScratch& scratch);

/// Returns the longest step without a viscosity solve for an incompressible liquid, if this step is
/// between half of `step` and `step`. Otherwise returns `step`. A viscosity solve costs about as
/// much as the rest of a step.
Real without_viscosity_solve(const Model& model, Real step);

/// Returns the longest step that resolves motion of `observed_rate` [rad/s], up to `step` and to
/// the nominal step, and after without_viscosity_solve().
Real limit_by_rate(const Model& model, Real step, Real observed_rate);
/// The first step is chosen after a probe of this share of the allowed step.
inline constexpr Real kProbeShare = 0.1;

/// Returns the lowest level l with nominal / 2^l <= step, at most kMaxStepLevel.
std::uint32_t level_of(Real step, Real nominal);

/// Returns the number of equal steps for the remaining part `left` of a nominal step, and stores
/// the step length in `history`. A step is at most `wanted` long, and at least nominal /
/// 2^kMaxStepLevel. The step length decreases immediately. The step length increases at most by a
/// factor of two, and only if the last change is at least kHeldSteps steps ago. Frequent changes
/// would change the energy, even with symplectic methods.
std::uint32_t choose_step_count(Real wanted, Real left, Real nominal, StepHistory& history);
inline constexpr std::uint32_t kHeldSteps = 4;

}  // namespace vat
