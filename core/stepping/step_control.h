#pragma once

#include <vector>

#include "core/evaluation/force_model.h"
#include "core/guard/guard.h"
#include "core/numerics/stable_step.h"
#include "core/stepping/step_control_contacts.h"

/// The steps that a state allows, and the choice of parts of the nominal step.
namespace vat {

/// The bounds of a model; empty for fixed steps.
StepBounds find_step_bounds(const Model& model);
/// Updates the bounds of a model in which only the initial position of one body and the gravity on
/// liquids have changed.
StepBounds step_bounds_of_moved(const Model& model, std::size_t body, StepBounds bounds);

/// The maximum steps that a state allows [s]; infinite without a limit.
struct PresentSteps {
  std::vector<Real> particle;  ///< by free particle; of liquids, without their forces
  std::vector<Real> rigid;     ///< by rigid body
  Real liquid = 0;             ///< by the forces of liquids
  ContactScratch contacts;
  std::vector<Real> pressures;  ///< buffer

  Real least() const;
};

/// Fills `steps` for the present state, for local and adaptive control:
///
/// - stability, with a margin, of the springs, contacts, sound and viscosity together: see
///   find_step_limits() for springs and liquids, and ContactPrediction;
/// - contacts that act, or may act before the end of the step, are resolved to the tolerance;
/// - travel, at the present speed and force: half the distance that the guard allows. In a liquid a
///   quarter of its support radius, in an incompressible one a fifth, relative to the mean motion
///   of the liquids;
/// - the pressure of an incompressible liquid, except for its highest hundredth: see
///   pressed_lattice_omega2();
/// - rigid bodies rotate by at most half a radian;
/// - grabs are stable, and the central field is resolved to the tolerance.
///
/// The usual criteria of SPH, 0.4 h_s / (c + |v|), 0.25 sqrt(h_s / |a|) and 0.125 h_s^2 / nu with
/// h_s = h / 2 (J. J. Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992) 543; J. P. Morris, P. J.
/// Fox, Y. Zhu, J. Comput. Phys. 136 (1997) 214), are four times below the stable step, for all
/// tolerances. Here sound is stable, with the accuracy that the estimate of MotionProbe requires.
///
/// `longest` [s]: the longest step of interest. Sorts the cells of the workspace.
void find_present_steps(const ForceModel& force_model, State& state, Real time, Real longest,
                        const StepBounds& bounds, const GuardBounds& guard, PresentSteps& steps);

/// The longest step in which local control can predict contacts, and that grabs and the central
/// field allow, which have no separate level [s]. Two particles that are not within twice the reach
/// of contacts do not touch in it.
Real greatest_base_step(const ForceModel& force_model, const State& state,
                        const StepBounds& bounds);

/// The longest step that needs no viscosity solve for an incompressible liquid, if it exceeds half
/// of `step`; such a solve costs about as much as the rest of a step. Otherwise `step`.
Real without_viscosity_solve(const Model& model, Real step);

/// The lowest level l with nominal / 2^l <= step, at most kMaxStepLevel.
std::uint32_t level_of(Real step, Real nominal);

/// The number of equal steps for the remaining part `left` of a nominal step. Each is at most
/// `wanted`, and at least nominal / 2^kMaxStepLevel. Stores their length. Steps get shorter
/// immediately. They get longer by at most a factor of two, and not within kHeldSteps steps of the
/// last change: frequent changes gain or lose energy even with symplectic methods.
std::uint32_t choose_step_count(Real wanted, Real left, Real nominal, StepHistory& history);
inline constexpr std::uint32_t kHeldSteps = 4;

}  // namespace vat
