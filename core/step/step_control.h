#pragma once

#include <vector>

#include "core/scene/stable_step.h"
#include "core/step/force_model.h"
#include "core/step/guard.h"
#include "core/step/step_control_contacts.h"

/// What steps a state allows, and the choice of a power-of-two part of the nominal step.
namespace vat {

/// What bounds the steps of a model whatever its state.
struct StepBounds {
  std::vector<Real> spring_step;  ///< by free particle, where its springs are stable [s]
  Real field_step = 0;            ///< that resolves the central field [s]; infinite without one
};
/// Empty where steps are fixed.
StepBounds find_step_bounds(const Model& model);

/// The greatest steps that a state allows [s]; infinite where nothing limits them.
struct PresentSteps {
  std::vector<Real> particle;  ///< by free particle; of liquids, without their own forces
  std::vector<Real> rigid;     ///< by rigid body
  Real liquid = 0;             ///< by the liquids' own forces
  ContactScratch contacts;

  Real least() const;
};

/// Fills `steps` for the present state; for local control and for adaptive control alike:
///
/// - springs: 0.9 of the stable step, omega^2 <= 2 lambda_max(sum_j k_ij n n^T) / m_i;
/// - contacts that act, or may before the step's end: see ContactOutlook;
/// - travel: half the way at which the guard interferes, at the present speed and force;
/// - rigid bodies turn by at most half a radian;
/// - liquids, with h_s = h / 2: 0.4 h_s / (c + |v|), 0.25 sqrt(h_s / |a|) and 0.125 h_s^2 / nu
///   (J. J. Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992) 543; J. P. Morris, P. J. Fox, Y. Zhu,
///   J. Comput. Phys. 136 (1997) 214);
/// - users' grabs are stable, and the central field is resolved to the tolerance.
///
/// `longest` [s] is the step beyond which nobody asks. Sorts the cells of the workspace.
void find_present_steps(const ForceModel& force_model, State& state, Real time, Real longest,
                        const StepBounds& bounds, const GuardBounds& guard, PresentSteps& steps);

/// The longest step in which local control can foresee contacts, and that users' grabs and the
/// central field allow, which have no level of their own [s]: two particles that are no neighbours
/// within twice the reach of contacts do not touch in it.
Real greatest_base_step(const ForceModel& force_model, const State& state,
                        const StepBounds& bounds);

/// The least level l with nominal / 2^l <= step, at most kMaxStepLevel.
std::uint32_t level_of(Real step, Real nominal);

/// The level of the next step of adaptive control, `position` steps of level kMaxStepLevel into the
/// nominal one. It rises to `wanted` at once; it falls by one where the longer step is aligned, and
/// not within kHeldSteps steps of the last change: steps that change often gain or lose energy
/// even in symplectic methods.
void choose_level(std::uint32_t wanted, std::uint32_t position, StepHistory& history);
inline constexpr std::uint32_t kHeldSteps = 4;

}  // namespace vat
