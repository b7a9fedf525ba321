#include "server/cli/simulate/simulate_run.h"

#include <algorithm>
#include <string>
#include <vector>

#include "protocol/files/text.h"

namespace vat {

namespace {

Status take_steps(Simulation& simulation, std::uint32_t count, const RunHooks& hooks,
                  RunTotals& totals) {
  const auto begin = std::chrono::steady_clock::now();
  const AdvanceReport report = simulation.advance(count);
  totals.stepping += std::chrono::steady_clock::now() - begin;
  totals.steps += report.steps;
  const bool first_event = totals.guard_events == 0 && !report.events.empty();
  totals.guard_events += report.undone_steps;
  totals.wall_stops += report.wall_stops;
  totals.unsolved_drifts += report.unsolved_drifts;
  totals.device_steps += report.device_steps;
  if (report.device_error) {
    hooks.notice(report.device_error->path + ": " + report.device_error->message +
                 "; the run continues on the CPU");
  }
  if (report.failed) return describe(report.events.back(), simulation);
  if (first_event) {
    const Error event = describe(report.events.front(), simulation);
    hooks.notice(event.path + ": " + event.message +
                 "; recovered with shorter steps, further events are only counted");
  }
  return {};
}

// The next stop: the end of the tick, an output time or the end of the run.
std::uint64_t next_stop(std::uint64_t step, std::uint64_t steps_per_tick,
                        const Schedule& schedule) {
  const auto next_multiple = [step](std::uint64_t of) { return (step / of + 1) * of; };
  return std::min({next_multiple(steps_per_tick), next_multiple(schedule.steps_per_output),
                   schedule.total_steps});
}

}  // namespace

Status run(Simulation& simulation, const Schedule& schedule, const RunHooks& hooks,
           RunTotals& totals, std::uint64_t step) {
  if (step == 0) {
    if (Status written = hooks.output(totals); !written) return written;
  }
  while (step < schedule.total_steps) {
    const std::uint64_t stop = next_stop(step, simulation.steps_per_tick(), schedule);
    const auto count = static_cast<std::uint32_t>(stop - step);
    if (Status taken = take_steps(simulation, count, hooks, totals); !taken) return taken;
    step = stop;
    if (Status go_on = hooks.progress(step, simulation.time()); !go_on) return go_on;
    if (step % schedule.steps_per_output != 0 && step != schedule.total_steps) continue;
    if (Status written = hooks.output(totals); !written) return written;
  }
  return {};
}

Error describe(const GuardEvent& event, const Simulation& simulation) {
  const std::vector<BodyView> bodies = simulation.bodies();
  const auto body = std::ranges::find(bodies, event.body, &BodyView::id);
  std::string path;
  std::string name = "?";
  if (body != bodies.end()) {
    path = "/bodies/" + std::to_string(body - bodies.begin());
    name = std::string(body->name);
  }
  std::string message = std::string("a step failed (") + to_string(event.cause) + ") at particle " +
                        std::to_string(event.particle) + " of body '" + name + "', at t = ";
  append_number(message, event.time);
  message += " s with a step of ";
  append_number(message, event.step);
  return {"guard", path, message + " s"};
}

}  // namespace vat
