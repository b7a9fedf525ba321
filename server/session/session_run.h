#pragma once

#include <cstdint>

#include "core/simulation.h"

namespace vat {

/// A session's simulation, counted in ticks, and the scene as it was loaded.
class SessionRun {
 public:
  explicit SessionRun(Simulation simulation);

  /// Replaces the simulation; the ticks begin at 0 and a new epoch.
  void load(Simulation simulation);
  /// Back to the scene as loaded, at tick 0 of a new epoch.
  void reset();
  /// Takes the steps of one tick. Where it failed, the state and the tick are as before.
  AdvanceReport advance();
  /// The bodies have changed.
  void start_epoch() { ++epoch_; }

  Simulation& simulation() { return simulation_; }
  const Simulation& simulation() const { return simulation_; }
  std::uint64_t tick() const { return tick_; }  ///< that were run since the start
  std::uint32_t epoch() const { return epoch_; }
  double tick_seconds() const { return simulation_.scene().numerics.tick; }

 private:
  Simulation simulation_;
  Snapshot as_loaded_;
  std::uint64_t tick_ = 0;
  std::uint32_t epoch_ = 1;
};

}  // namespace vat
