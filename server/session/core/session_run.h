#pragma once

#include <cstdint>
#include <optional>

#include "core/simulation/simulation.h"
#include "server/history/session_moment.h"
#include "server/operations/server_metrics.h"
#include "server/session/ticks/tick_profile.h"
#include "server/support/resource_budget.h"

namespace vat {

/// Simulation of a session, its counts of ticks, and the state of a reset.
class SessionRun {
 public:
  /// `share`: part of the budget of all sessions.
  SessionRun(Simulation simulation, ResourceShare share, ServerMetrics& metrics);

  /// Continues from another moment of the session's history. `as_loaded` is the state of a reset.
  void resume(Simulation simulation, Snapshot as_loaded, const SessionMoment& moment);
  /// Takes the budget that another simulation needs. Returns the limit if it would be exceeded.
  std::optional<LimitExcess> admit(const Simulation& next);
  /// Takes the greater budget of both simulations.
  std::optional<LimitExcess> admit(const Simulation& next, const Simulation& as_loaded);
  /// Takes the budget that the changed simulation needs, at least that of a reset.
  std::optional<LimitExcess> admit_change();
  /// Moves the share to another budget, even beyond its limits.
  void move_share(ResourceBudget& budget) { share_ = budget.take_anyway(share_.amount()); }
  /// Takes the budget that the simulation needs, even beyond the limits.
  void resize_share_anyway();
  /// Returns the budget. The simulation does not run any more.
  void end() { share_.resize({}); }
  /// Replaces the simulation. Starts at tick 0 of a new epoch, with a new profile.
  void load(Simulation simulation);
  /// Replaces the simulation by one that has run `tick` ticks since it was `as_loaded`.
  void restore(Simulation simulation, const Simulation& as_loaded, std::uint64_t tick);
  /// Restores the loaded state, at tick 0 of a new epoch.
  void reset();
  const Snapshot& as_loaded() const { return as_loaded_; }
  /// Runs the steps of one tick. If they fail, state and tick are unchanged.
  AdvanceReport advance();
  /// Starts an epoch because the bodies have changed.
  void start_epoch() { ++epoch_; }
  void set_epoch(std::uint32_t epoch) { epoch_ = epoch; }
  /// Skips epochs that clients may have seen before a recovery.
  void skip_epochs(std::uint32_t count) { epoch_ += count; }

  Simulation& simulation() { return simulation_; }
  const Simulation& simulation() const { return simulation_; }
  /// Of the ticks since the scene was loaded.
  const TickProfile& profile() const { return profile_; }
  std::uint64_t tick() const { return tick_; }  ///< ticks since the scene was loaded or reset
  /// All ticks of the session, including those before loads and resets.
  std::uint64_t position() const { return position_; }
  std::uint32_t epoch() const { return epoch_; }
  /// Greatest id of a grab so far.
  std::uint64_t last_grab() const { return last_grab_; }
  void set_last_grab(std::uint64_t grab) { last_grab_ = grab; }
  double tick_seconds() const { return simulation_.scene().numerics.tick; }

 private:
  ServerMetrics& metrics_;
  Simulation simulation_;
  Snapshot as_loaded_;
  Resources needed_as_loaded_;
  ResourceShare share_;
  TickProfile profile_;
  std::uint64_t tick_ = 0;
  std::uint64_t position_ = 0;
  std::uint32_t epoch_ = 1;
  std::uint64_t last_grab_ = 0;
};

}  // namespace vat
