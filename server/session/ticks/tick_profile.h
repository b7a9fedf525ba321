#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/stage/advance_report.h"
#include "core/stage/observer.h"
#include "server/operations/server_metrics.h"
#include "server/support/stage_clock.h"

namespace vat {

/// Cost of a session's ticks, by stage. A stage is a part of a simulation step. The profile is
/// always active. If the measurement of every tick would cost more than 0.5 % of the time, only
/// some ticks are measured. Each measured tick then represents all ticks since the previous
/// measured tick.
class TickProfile {
 public:
  using Clock = StageClock::Clock;
  struct Totals {
    std::uint64_t ticks = 0;
    std::uint64_t substeps = 0;  ///< includes repeated and undone substeps
    std::uint64_t undone_substeps = 0;
    std::uint64_t device_steps = 0;  ///< see AdvanceReport
    Clock::duration time{};
    Clock::duration longest_tick{};
    std::vector<StageClock::Stage> stages;  ///< in the order of their first execution
  };

  /// Returns the observer of the next tick, or null if the next tick is not measured.
  StageObserver* next_observer();
  /// Adds a tick to this profile and to the server's metrics.
  void tick_done(Clock::duration time, const AdvanceReport& report, ServerMetrics& metrics);
  const Totals& totals() const { return totals_; }
  /// Returns the stages of the last tick in their order. Empty if it was not measured.
  std::span<const StageClock::Span> spans() const;

 private:
  void count_stages(Clock::duration tick_time);

  Totals totals_;
  StageClock clock_;                            // of the current measured tick
  std::vector<StageClock::Stage> tick_stages_;  // represented by the last measured tick
  std::uint64_t period_ = 1;                    // one of period_ ticks is measured
  std::uint64_t ticks_since_measured_ = 0;      // ticks since the last measured tick
  bool is_measured_ = false;
};

}  // namespace vat
