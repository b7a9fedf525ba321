#pragma once

#include "core/stepping/local_levels.h"
#include "core/stepping/local_pairs.h"

namespace vat {

/// Local step control: steps of a power of two for each particle (L. Hernquist, N. Katz, Astrophys.
/// J. Suppl. Ser. 70 (1989) 419), as nested kick-drift-kick steps. The force of a connection has
/// the finer level of its particles and kicks both ends at once, over the step of this level.
/// Between kicks all particles drift on the finest level. The nesting is that of the reversible
/// multiple-time-step method (M. Tuckerman, B. J. Berne, G. J. Martyna, J. Chem. Phys. 97 (1992)
/// 1990) with a level for each connection: order 2, symplectic for constant levels, with momentum
/// and angular momentum conserved up to rounding. Dashpots use the velocities before the kick, so
/// that damping has order 1.
///
/// Springs and contacts have the level of their connection, and walls that of their particle. All
/// forces of liquids have one common level. Gravity, fields and forces of users have level 0.
class LocalStepper {
 public:
  /// Takes a step of `dt` seconds from `time`. The levels were chosen at the end of the last step;
  /// they are chosen again if the forces of the state are not current.
  void take_step(const ForceModel& force_model, State& state, Real time, Real dt,
                 const StepBounds& bounds, const GuardBounds& guard);
  /// The first particle or rigid body that moved further in a step of its level than the guard
  /// allows, after a step of `dt`.
  std::optional<Fault> find_fast(const Model& model, const Configuration& at, Real dt,
                                 const GuardBounds& guard) const;
  /// Call it after a change of the state by something other than a step.
  void forget() { pairs_current_ = false; }

  /// The finest and the coarsest level of particles in the last step; 0 before the first.
  int finest() const { return finest_; }
  int coarsest() const { return coarsest_; }

 private:
  struct Moment;
  void set_levels(const Moment& now, State& state, Real dt, const StepBounds& bounds,
                  const GuardBounds& guard);
  void build_pairs(const Moment& now);
  void evaluate_all(const Moment& now, const LocalLevels& closing, const LocalLevels& opening,
                    Forces& closing_forces, Forces& opening_forces);
  void sum_connections(const Moment& now, const LocalLevels& closing, const LocalLevels& opening,
                       Forces& closing_forces, Forces& opening_forces);
  void kick_due(const Moment& now, int due, Real dt);
  void kick_liquid(const Moment& now, Real dt);
  void kick_rigid(const Moment& now, Real dt);
  const std::vector<Vec3>& evaluate_liquid(const Moment& now);

  LocalPairs pairs_;
  bool pairs_current_ = false;
  PresentSteps present_;
  LocalLevels closing_levels_;
  Forces closing_;  ///< forces at the end of a step
  Forces due_;      ///< forces of a sub-step; zero in between
  Forces liquid_;   ///< forces of liquids
  int finest_ = 0;
  int coarsest_ = 0;
};

}  // namespace vat
