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
  std::uint64_t steps = 0;  ///< includes repeated steps
  std::uint64_t guard_events = 0;
  std::uint64_t wall_stops = 0;               ///< see AdvanceReport
  std::uint64_t unsolved_drifts = 0;          ///< see AdvanceReport
  std::uint64_t device_steps = 0;             ///< steps that a device has taken
  std::chrono::duration<double> stepping{0};  ///< wall time of all steps
};

/// Callbacks of a run.
struct RunHooks {
  std::function<Status(const RunTotals&)> output;                 ///< called at each output time
  std::function<Status(std::uint64_t step, Real time)> progress;  ///< called after each tick
  std::function<void(const std::string&)> notice;  ///< called at the first repaired guard event
};

/// Runs the steps of the schedule tick by tick, like a server, so that both compute the same
/// states. Ends if a callback returns an error, or if the guard rejects a step. `step` is the
/// number of steps that the simulation has taken before; the output of this step exists, unless it
/// is 0.
Status run(Simulation& simulation, const Schedule& schedule, const RunHooks& hooks,
           RunTotals& totals, std::uint64_t step = 0);

/// Returns an error that describes a guard event, with the path of the body.
Error describe(const GuardEvent& event, const Simulation& simulation);

}  // namespace vat
