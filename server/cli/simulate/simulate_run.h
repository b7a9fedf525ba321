#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include "core/simulation/simulation.h"
#include "core/support/result.h"
#include "server/cli/simulate/simulate_schedule.h"

namespace vat {

/// Totals of a run.
struct RunTotals {
  std::uint64_t steps = 0;  ///< includes retries
  std::uint64_t guard_events = 0;
  std::uint64_t wall_stops = 0;               ///< as AdvanceReport counts them
  std::uint64_t unsolved_drifts = 0;          ///< as AdvanceReport counts them
  std::chrono::duration<double> stepping{0};  ///< wall time spent in steps
};

/// Functions that a run calls.
struct RunHooks {
  std::function<Status(const RunTotals&)> output;                 ///< at each output time
  std::function<Status(std::uint64_t step, Real time)> progress;  ///< after each tick
  std::function<void(const std::string&)> notice;                 ///< at the first recovered event
};

/// Runs the steps of the schedule, tick by tick like a server, so that both reach the same states.
/// Ends at the first hook that fails, and at a step that the guard rejects.
Status run(Simulation& simulation, const Schedule& schedule, const RunHooks& hooks,
           RunTotals& totals);

/// Returns a guard event as an error with the path of its body.
Error describe(const GuardEvent& event, const Simulation& simulation);

}  // namespace vat
