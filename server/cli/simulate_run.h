#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include "core/simulation/simulation.h"
#include "core/support/result.h"
#include "server/cli/simulate_schedule.h"

namespace vat {

/// What a run has done so far.
struct RunTotals {
  std::uint64_t steps = 0;  ///< retries included
  std::uint64_t guard_events = 0;
  std::uint64_t wall_stops = 0;               ///< as AdvanceReport counts them
  std::uint64_t unsolved_drifts = 0;          ///< the same
  std::chrono::duration<double> stepping{0};  ///< wall time spent in steps
};

/// What happens at the stops of a run.
struct RunHooks {
  std::function<Status(const RunTotals&)> output;                 ///< at each output time
  std::function<Status(std::uint64_t step, Real time)> progress;  ///< after each tick
  std::function<void(const std::string&)> notice;                 ///< at the first recovered event
};

/// Takes the schedule's steps, tick by tick like a server, so that both reach the same states. Ends
/// at the first hook that fails, and at a step that the guard could not save.
Status run(Simulation& simulation, const Schedule& schedule, const RunHooks& hooks,
           RunTotals& totals);

/// What a guard event says to a user; the path is the body's in the scene.
Error describe(const GuardEvent& event, const Simulation& simulation);

}  // namespace vat
