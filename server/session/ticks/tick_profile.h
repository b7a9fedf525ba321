#pragma once

#include <cstdint>
#include <vector>

#include "core/simulation/simulation.h"
#include "server/operations/server_metrics.h"
#include "server/support/stage_clock.h"

namespace vat {

/// Cost of a session's ticks, by stage. Always on: if measuring every tick would cost more than
/// half a percent, only some ticks are measured, and each represents those since the one before.
class TickProfile {
 public:
  using Clock = StageClock::Clock;
  struct Totals {
    std::uint64_t ticks = 0;
    std::uint64_t substeps = 0;  ///< includes repeated and undone ones
    std::uint64_t undone_substeps = 0;
    Clock::duration time{};
    Clock::duration longest_tick{};
    std::vector<StageClock::Stage> stages;  ///< in the order in which they first ran
  };

  /// Returns the observer of the next tick, or null if it is not measured.
  StageObserver* next_observer();
  /// Adds a tick to this profile and to the server's metrics.
  void tick_done(Clock::duration time, const AdvanceReport& report, ServerMetrics& metrics);
  const Totals& totals() const { return totals_; }

 private:
  void count_stages(Clock::duration tick_time);

  Totals totals_;
  StageClock clock_;                            // of a measured tick
  std::vector<StageClock::Stage> tick_stages_;  // represented by such a tick
  std::uint64_t period_ = 1;                    // one of so many ticks is measured
  std::uint64_t ticks_since_measured_ = 0;      // ticks since the last measured one
  bool is_measured_ = false;
};

}  // namespace vat
