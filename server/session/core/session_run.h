#pragma once

#include <cstdint>
#include <optional>

#include "core/simulation/simulation.h"
#include "server/history/session_moment.h"
#include "server/operations/server_metrics.h"
#include "server/session/ticks/tick_profile.h"
#include "server/support/resource_budget.h"

namespace vat {

/// Simulation of a session, its tick counts, and the state that a reset restores.
class SessionRun {
 public:
  /// `share` is the session's part of the server's resource budget.
  SessionRun(Simulation simulation, ResourceShare share, ServerMetrics& metrics);

  /// Continues from another moment of the session's history. `as_loaded` is the state that a reset
  /// restores.
  void resume(Simulation simulation, Snapshot as_loaded, const SessionMoment& moment);
  /// Reserves the resources of another simulation. Returns the limit that would be exceeded, if
  /// any.
  std::optional<LimitExcess> admit(const Simulation& next);
  /// Reserves, for each resource, the maximum of both simulations. Returns the limit that would be
  /// exceeded, if any.
  std::optional<LimitExcess> admit(const Simulation& next, const Simulation& as_loaded);
  /// Reserves the resources of the changed simulation, and at least the resources of the reset
  /// state.
  std::optional<LimitExcess> admit_change();
  /// Moves the reservation to another budget, even beyond its limits.
  void move_share(ResourceBudget& budget) { share_ = budget.take_anyway(share_.amount()); }
  /// Reserves the resources of the simulation, even beyond the limits.
  void resize_share_anyway();
  /// Releases all resources. The simulation must not run afterwards.
  void end() { share_.resize({}); }
  /// Replaces the simulation and clears the profile. Starts a new epoch at tick 0.
  void load(Simulation simulation);
  /// Replaces the simulation. The new simulation has run `tick` ticks since the state `as_loaded`.
  void restore(Simulation simulation, const Simulation& as_loaded, std::uint64_t tick);
  /// Restores the loaded state. Starts a new epoch at tick 0.
  void reset();
  const Snapshot& as_loaded() const { return as_loaded_; }
  /// Runs the steps of one tick. If a step fails, state and tick count are unchanged.
  AdvanceReport advance();
  /// Starts an epoch because the bodies have changed.
  void start_epoch() { ++epoch_; }
  void set_epoch(std::uint32_t epoch) { epoch_ = epoch; }
  /// Skips epochs that clients may have received before a recovery.
  void skip_epochs(std::uint32_t count) { epoch_ += count; }

  Simulation& simulation() { return simulation_; }
  const Simulation& simulation() const { return simulation_; }
  /// Returns the profile of all ticks since the scene was loaded.
  const TickProfile& profile() const { return profile_; }
  std::uint64_t tick() const { return tick_; }  ///< ticks since the scene was loaded or reset
  /// Returns the number of all ticks of the session, including ticks before loads and resets.
  std::uint64_t position() const { return position_; }
  std::uint32_t epoch() const { return epoch_; }
  /// Returns the greatest grab id that was used.
  std::uint64_t last_grab() const { return last_grab_; }
  void set_last_grab(std::uint64_t grab) { last_grab_ = grab; }
  /// Returns the device of the steps: the device of the loaded scene, or the CPU if the device is
  /// no longer used.
  DeviceChoice device() const;
  /// Returns whether the CPU computes a scene that has a device.
  bool has_lost_device() const {
    return as_loaded_.scene().numerics.device.has_value() && !simulation_.has_engine();
  }
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
