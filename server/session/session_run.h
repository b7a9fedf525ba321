#pragma once

#include <cstdint>
#include <optional>

#include "core/simulation/simulation.h"
#include "server/admission/resource_budget.h"
#include "server/server_metrics.h"
#include "server/session/tick_profile.h"

namespace vat {

/// A session's simulation, counted in ticks, and the scene as it was loaded.
class SessionRun {
 public:
  /// `share` is what it has of the budget of all sessions.
  SessionRun(Simulation simulation, ResourceShare share, ServerMetrics& metrics);

  /// Goes on from elsewhere in the history of a session. `as_loaded` is what it resets to.
  void resume(Simulation simulation, Snapshot as_loaded, std::uint64_t position, std::uint64_t tick,
              std::uint32_t epoch);
  /// Takes what another simulation needs in place of this one's. What would be too much, if so.
  std::optional<ResourceExcess> admit(const Simulation& next);
  /// The same of one that goes back to another.
  std::optional<ResourceExcess> admit(const Simulation& next, const Simulation& as_loaded);
  /// Takes what this simulation needs now that it has changed. At least what it needed when it was
  /// loaded, since it may go back to that.
  std::optional<ResourceExcess> admit_change();
  /// What it has is counted in another budget from now on, even beyond that one's limits.
  void move_share(ResourceBudget& budget) { share_ = budget.take_anyway(share_.amount()); }
  /// Takes what the simulation needs, even beyond the limits.
  void resize_share_anyway();
  /// Gives back what it has of the budget; nothing runs any more.
  void end() { share_.resize({}); }
  /// Replaces the simulation; the ticks begin at 0, and a new epoch and profile.
  void load(Simulation simulation);
  /// Replaces the simulation by one that has run so many ticks since it was `as_loaded`.
  void restore(Simulation simulation, const Simulation& as_loaded, std::uint64_t tick);
  /// Back to the scene as loaded, at tick 0 of a new epoch.
  void reset();
  const Snapshot& as_loaded() const { return as_loaded_; }
  /// Takes the steps of one tick. Where it failed, the state and the tick are as before.
  AdvanceReport advance();
  /// The bodies have changed.
  void start_epoch() { ++epoch_; }
  void set_epoch(std::uint32_t epoch) { epoch_ = epoch; }
  /// Epochs go on behind those that clients may have seen of a session that comes back.
  void skip_epochs(std::uint32_t count) { epoch_ += count; }

  Simulation& simulation() { return simulation_; }
  const Simulation& simulation() const { return simulation_; }
  /// Of the ticks since the scene was loaded.
  const TickProfile& profile() const { return profile_; }
  std::uint64_t tick() const { return tick_; }  ///< that were run since the start
  /// All ticks that the session has ever run, whatever was loaded or reset.
  std::uint64_t position() const { return position_; }
  std::uint32_t epoch() const { return epoch_; }
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
};

}  // namespace vat
