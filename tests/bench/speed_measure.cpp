#include "tests/bench/speed_measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "core/simulation.h"
#include "server/cli/simulate_run.h"
#include "server/task_runner.h"

namespace vat::bench {

namespace {

/// Advances by whole ticks that cover `interval`; gives the number of steps taken.
Result<std::uint64_t> advance_by(Simulation& simulation, Real interval) {
  const std::uint32_t steps_per_tick = simulation.steps_per_tick();
  const Real tick = simulation.step_size() * steps_per_tick;
  const auto ticks = std::max(1L, std::lround(interval / tick));
  std::uint64_t steps = 0;
  for (long i = 0; i < ticks; ++i) {
    const AdvanceReport report = simulation.advance(steps_per_tick);
    if (report.failed) return describe(report.events.back(), simulation);
    steps += report.steps;
  }
  return steps;
}

/// One timed repetition; gives the wall time of a step [ms].
Result<Real> time_repetition(Simulation& simulation, SpeedRow& row, Real interval) {
  const Real begin_time = simulation.time();
  const auto begin = std::chrono::steady_clock::now();
  const Result<std::uint64_t> steps = advance_by(simulation, interval);
  const std::chrono::duration<Real, std::milli> wall = std::chrono::steady_clock::now() - begin;
  if (!steps) return steps.errors();
  row.steps = steps.value();
  row.simulated = simulation.time() - begin_time;
  return wall.count() / static_cast<Real>(row.steps);
}

SpeedRow describe_run(const Simulation& simulation, std::size_t threads) {
  SpeedRow row;
  row.scene = simulation.scene().name;
  row.integrator = to_string(simulation.scene().numerics.integrator);
  row.particles = simulation.particle_count();
  row.springs = simulation.spring_count();
  row.threads = threads;
  row.instructions = simulation.instruction_set();
  return row;
}

Real median_of_sorted(const std::vector<Real>& values) {
  const std::size_t middle = values.size() / 2;
  if (values.size() % 2 == 1) return values[middle];
  return 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace

Real SpeedRow::particle_steps_per_second() const {
  return static_cast<Real>(particles) / (median_ms_per_step * 1e-3);
}

Real SpeedRow::real_time_factor() const {
  return simulated / (median_ms_per_step * 1e-3 * static_cast<Real>(steps));
}

Result<SpeedRow> measure(const Scene& scene, std::size_t threads, const SpeedSettings& settings) {
  ThreadPoolRunner runner(threads);
  Result<Simulation> created = Simulation::create(scene, &runner);
  if (!created) return created.errors();
  Simulation& simulation = created.value();
  const Result<std::uint64_t> warmed_up = advance_by(simulation, settings.warm_up);
  if (!warmed_up) return warmed_up.errors();
  const Snapshot start = simulation.snapshot();
  SpeedRow row = describe_run(simulation, threads);
  std::vector<Real> times;
  for (int i = 0; i < settings.repetitions; ++i) {
    simulation.restore(start);
    const Result<Real> time = time_repetition(simulation, row, settings.measured);
    if (!time) return time.errors();
    times.push_back(time.value());
    const std::uint64_t hash = simulation.state_hash();
    if (i > 0 && hash != row.state_hash) {
      return Error{"not_deterministic", "", "two runs from one snapshot end in different states"};
    }
    row.state_hash = hash;
  }
  std::ranges::sort(times);
  row.median_ms_per_step = median_of_sorted(times);
  row.min_ms_per_step = times.front();
  return row;
}

}  // namespace vat::bench
