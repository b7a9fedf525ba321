#pragma once

#include "core/guard/guard.h"
#include "core/stepping/control/step_control.h"
#include "core/stepping/local_pairs.h"

namespace vat {

/// Local step control: particles take steps of different lengths, which are a common step divided
/// by powers of two (L. Hernquist, N. Katz, Astrophys. J. Suppl. Ser. 70 (1989) 419). The steps are
/// nested kick-drift-kick steps. A connection has the finer level of its two particles, and changes
/// the velocities of both ends simultaneously over the step of this level. Between kicks, all
/// particles drift with the finest step. The scheme is the reversible multiple-time-step method (M.
/// Tuckerman, B. J. Berne, G. J. Martyna, J. Chem. Phys. 97 (1992) 1990), with a level for each
/// connection. The method has order 2 and is symplectic for constant levels. Momentum and angular
/// momentum are conserved up to rounding. Dashpots depend on the velocities before the kick, so
/// that damping has order 1.
///
/// The force of a wall has the level of the particle. All forces of gas liquids have one common
/// level. Gravity, the central field and forces of users have level 0.
///
/// Coupled liquids (tait, incompressible) have level 0: the whole step is a step of the liquid, and
/// solids take sub-steps within it. The forces between liquids and solids are impulses at the ends
/// of the whole step, equal and opposite on both sides, so that momentum is conserved up to
/// rounding. The order is that of the solver: 2 with tait. An incompressible liquid takes steps of
/// symplectic Euler: its forces act at the start of the step, over the whole step.
class LocalStepper {
 public:
  /// Takes a step of `dt` [s] from `time` [s], with the levels that were chosen at the end of the
  /// last step. If the forces of the state are not current, the levels are chosen again.
  void take_step(const ForceModel& force_model, State& state, Real time, Real dt,
                 const StepBounds& bounds, const GuardBounds& guard);
  /// Returns the first particle or rigid body whose motion in a step of its own level exceeded the
  /// bounds of `guard`. Must be called after a whole step of `dt` [s].
  std::optional<Fault> find_fast(const Model& model, const Configuration& at, Real dt,
                                 const GuardBounds& guard) const;
  /// Discards the list of connections. Must be called after any change of the state outside
  /// take_step().
  void forget() { pairs_current_ = false; }

  /// Return the finest and the coarsest level of particles in the last step; 0 before the first
  /// step.
  int finest() const { return finest_; }
  int coarsest() const { return coarsest_; }

 private:
  struct Moment;
  /// The lengths of the kicks of liquids at the end of a step and at the start of the next, in half
  /// steps.
  struct LiquidKicks {
    Real closing;
    Real opening;
    bool are_none() const { return closing == 0 && opening == 0; }
  };
  void set_levels(const Moment& now, State& state, Real dt, const StepBounds& bounds,
                  const GuardBounds& guard);
  void build_pairs(const Moment& now);
  /// Computes the forces at the end of a step and at the start of the next.
  void evaluate_all(const Moment& now, const LocalLevels& closing, const LocalLevels& opening,
                    LiquidKicks kicks, Forces& closing_forces, Forces& opening_forces);
  void add_liquid_forces(const Moment& now, const LocalLevels& closing, const LocalLevels& opening,
                         LiquidKicks kicks, Forces& closing_forces, Forces& opening_forces);
  void evaluate_at_start(const Moment& start, Real dt, const StepBounds& bounds,
                         const GuardBounds& guard);
  void evaluate_at_end(const Moment& end, Real dt, const StepBounds& bounds,
                       const GuardBounds& guard);
  void drift_in_parts(const ForceModel& force_model, State& state, Real time, Real dt);
  void sum_connections(const Moment& now, const LocalLevels& closing, const LocalLevels& opening,
                       Forces& closing_forces, Forces& opening_forces);
  void kick_due(const Moment& now, int due, Real dt);
  void kick_liquid(const Moment& now, Real dt);
  void kick_rigid(const Moment& now, Real dt);
  const Forces& evaluate_liquid(const Moment& now);

  static constexpr LiquidKicks kVerlet{1, 1};
  // Symplectic Euler, in which the end of a step is not the start of the next.
  static constexpr LiquidKicks kEulerStart{0, 2};
  static constexpr LiquidKicks kEulerEnd{0, 0};

  LocalPairs pairs_;
  bool pairs_current_ = false;
  PresentSteps present_;
  LocalLevels closing_levels_;
  Forces closing_;  ///< forces at the end of a step
  Forces due_;      ///< forces of a sub-step; zero between sub-steps
  Forces liquid_;   ///< forces of liquids
  int finest_ = 0;
  int coarsest_ = 0;
};

}  // namespace vat
