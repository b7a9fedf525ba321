#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "core/simulation/simulation.h"
#include "server/server_metrics.h"
#include "server/stage_clock.h"

namespace vat {

/// What the ticks of a session cost, and on what. Always on: where looking at the stages of every
/// tick would cost more than half a percent of them, only some ticks are looked at, and each stands
/// for those since the one before.
class TickProfile {
 public:
  using Clock = StageClock::Clock;
  struct Totals {
    std::uint64_t ticks = 0;
    std::uint64_t substeps = 0;  ///< parts of steps and undone ones included
    std::uint64_t undone_substeps = 0;
    Clock::duration time{};
    Clock::duration longest_tick{};
    std::vector<StageClock::Stage> stages;  ///< in the order in which they first began
  };

  /// Of the tick that comes; null where it is not looked at.
  StageObserver* next_observer();
  /// Counts it in here and in the server's.
  void tick_done(Clock::duration time, const AdvanceReport& report, ServerMetrics& metrics);
  const Totals& totals() const { return totals_; }

 private:
  void count_stages(Clock::duration tick_time);

  Totals totals_;
  StageClock clock_;                            // of a tick that is looked at
  std::vector<StageClock::Stage> tick_stages_;  // what such a tick stands for
  std::uint64_t period_ = 1;                    // one of so many is looked at
  std::uint64_t since_look_ = 0;                // ticks that no look stands for yet
  bool is_looking_ = false;
};

}  // namespace vat
