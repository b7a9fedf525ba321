#pragma once

#include <vector>

#include "core/evaluation/force_model.h"
#include "core/guard/guard.h"
#include "core/numerics/stable_step.h"
#include "core/stepping/step_control_contacts.h"

/// What steps a state allows, and the choice of a part of the nominal step.
namespace vat {

/// Empty where steps are fixed.
StepBounds find_step_bounds(const Model& model);
/// The same from those of a model that differs in where one body begins, and in how gravity weighs
/// on liquids.
StepBounds step_bounds_of_moved(const Model& model, std::size_t body, StepBounds bounds);

/// The greatest steps that a state allows [s]; infinite where nothing limits them.
struct PresentSteps {
  std::vector<Real> particle;  ///< by free particle; of liquids, without their own forces
  std::vector<Real> rigid;     ///< by rigid body
  Real liquid = 0;             ///< by the liquids' own forces
  ContactScratch contacts;
  std::vector<Real> pressures;  ///< scratch

  Real least() const;
};

/// Fills `steps` for the present state; for local control and for adaptive control alike:
///
/// - stability, with a margin, of the springs, contacts, sound and viscosity that act together: see
///   find_step_limits() for those of springs and liquids, and ContactPrediction;
/// - contacts that act, or may before the step's end, are resolved to the tolerance;
/// - travel, at the present speed and force: half the way at which the guard interferes; in a
///   liquid a quarter of its support radius, of an incompressible one a fifth, measured in the
///   liquids' mean motion;
/// - the pressure of an incompressible liquid, but for its greatest hundredth: see
///   pressed_lattice_omega2();
/// - rigid bodies turn by at most half a radian;
/// - users' grabs are stable, and the central field is resolved to the tolerance.
///
/// The usual criteria of SPH, 0.4 h_s / (c + |v|), 0.25 sqrt(h_s / |a|) and 0.125 h_s^2 / nu with
/// h_s = h / 2 (J. J. Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992) 543; J. P. Morris, P. J.
/// Fox, Y. Zhu, J. Comput. Phys. 136 (1997) 214), stay four times below the stable step whatever
/// the tolerance; here sound is stable, and as accurate as MotionProbe's estimate asks for.
///
/// `longest` [s] is the step beyond which nobody asks. Sorts the cells of the workspace.
void find_present_steps(const ForceModel& force_model, State& state, Real time, Real longest,
                        const StepBounds& bounds, const GuardBounds& guard, PresentSteps& steps);

/// The longest step in which local control can foresee contacts, and that users' grabs and the
/// central field allow, which have no level of their own [s]: two particles that are no neighbours
/// within twice the reach of contacts do not touch in it.
Real greatest_base_step(const ForceModel& force_model, const State& state,
                        const StepBounds& bounds);

/// The longest step in which an incompressible liquid need not be solved for its viscosity, where
/// that is more than half of `step`; such a solve costs about as much as the rest of a step.
/// Otherwise `step`.
Real without_viscosity_solve(const Model& model, Real step);

/// The least level l with nominal / 2^l <= step, at most kMaxStepLevel.
std::uint32_t level_of(Real step, Real nominal);

/// In how many equal steps to go on for what is left of a nominal one, all at most `wanted` long
/// but no less than nominal / 2^kMaxStepLevel; notes their length. Steps get shorter at once; they
/// get longer, at most twice as long, not within kHeldSteps steps of the last change: steps that
/// change often gain or lose energy even in symplectic methods.
std::uint32_t choose_step_count(Real wanted, Real left, Real nominal, StepHistory& history);
inline constexpr std::uint32_t kHeldSteps = 4;

}  // namespace vat
