#pragma once

#include <cstdint>
#include <optional>

#include "core/simulation/simulation.h"
#include "core/support/check.h"
#include "server/session/core/session_run.h"

namespace vat {

/// State of a session at one time, for reads on another thread. Independent of the session.
class SessionView {
 public:
  /// Copies the state of the simulation only if `with_state` is true, because the copy takes time.
  SessionView(const SessionRun& run, bool with_state)
      : as_loaded_(run.as_loaded()),
        time_(run.simulation().time()),
        tick_(run.tick()),
        position_(run.position()) {
    if (with_state) snapshot_.emplace(run.simulation().snapshot());
  }

  const Snapshot& as_loaded() const { return as_loaded_; }  ///< see SessionRun::as_loaded()
  double time() const { return time_; }                     ///< simulated time [s]
  std::uint64_t tick() const { return tick_; }              ///< see SessionRun::tick()
  std::uint64_t position() const { return position_; }      ///< see SessionRun::position()
  /// Returns the state of the simulation. The view must have been created with it.
  const Snapshot& snapshot() const {
    VAT_CHECK(snapshot_.has_value());
    return *snapshot_;
  }
  /// Returns a simulation in the state snapshot(). The first call creates the simulation.
  const Simulation& simulation() {
    if (!simulation_) simulation_.emplace(Simulation::from(snapshot()));
    return *simulation_;
  }

 private:
  const Snapshot as_loaded_;
  std::optional<Snapshot> snapshot_;
  const double time_;
  const std::uint64_t tick_;
  const std::uint64_t position_;
  std::optional<Simulation> simulation_;
};

}  // namespace vat
