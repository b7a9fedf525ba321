#pragma once

#include "core/stepping/local_levels.h"
#include "core/stepping/local_pairs.h"

namespace vat {

/// Local step control: power-of-two steps by particle (L. Hernquist, N. Katz, Astrophys. J. Suppl.
/// Ser. 70 (1989) 419), as nested kick-drift-kick steps. The force of a connection belongs to the
/// finer of its particles' levels and kicks both ends at once, by what a step of that level takes;
/// between kicks all particles drift on the finest level. The nesting is that of the reversible
/// multiple-time-step method (M. Tuckerman, B. J. Berne, G. J. Martyna, J. Chem. Phys. 97 (1992)
/// 1990) with a level for each connection: of order 2, symplectic while the levels stay, and with
/// momentum and angular momentum conserved to rounding. Dashpots take the velocities from before
/// the kick, so in damping the order is 1.
///
/// Springs and contacts have the level of their connection, walls that of their particle, and the
/// liquids' forces one for all liquids; gravity, fields and what users apply belong to level 0.
class LocalStepper {
 public:
  /// A step of `dt` seconds from `time`. Its levels were chosen when the one before it closed, or
  /// are chosen now where the forces of the state are not current.
  void take_step(const ForceModel& force_model, State& state, Real time, Real dt,
                 const StepBounds& bounds, const GuardBounds& guard);
  /// The first particle or rigid body that moved further in a step of its level than the guard
  /// allows, as it is after a step of `dt`.
  std::optional<Fault> find_fast(const Model& model, const Configuration& at, Real dt,
                                 const GuardBounds& guard) const;
  /// Something else than a step has changed the state.
  void forget() { pairs_current_ = false; }

  /// The finest and the coarsest level of particles in the last step; 0 before it.
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
  Forces closing_;  ///< forces that close a step
  Forces due_;      ///< of a sub-step; zero between them
  Forces liquid_;   ///< the liquids' own
  int finest_ = 0;
  int coarsest_ = 0;
};

}  // namespace vat
