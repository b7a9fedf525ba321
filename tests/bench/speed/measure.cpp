#include "tests/bench/speed/measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "core/device/device_use.h"
#include "core/simulation/simulation.h"
#include "server/cli/simulate/simulate_run.h"
#include "tests/bench/report/table.h"
#include "tests/bench/speed/machine.h"
#include "tests/bench/speed/neighbours.h"
#include "tests/bench/speed/switch_runner.h"

namespace vat::bench {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kMaxSamples = 256;  // of diagnostics, each as expensive as a step

Real speed_seconds_since(Clock::time_point begin) {
  return std::chrono::duration<Real>(Clock::now() - begin).count();
}

/// Returns the number of nominal steps that cover the interval in whole ticks.
std::uint64_t speed_steps_of(const Simulation& simulation, Real interval) {
  const std::uint32_t steps_per_tick = simulation.steps_per_tick();
  const Real tick = simulation.step_size() * steps_per_tick;
  if (interval <= 0) return 0;
  return static_cast<std::uint64_t>(std::max(1L, std::lround(interval / tick))) * steps_per_tick;
}

/// Advances by `steps` nominal steps, tick by tick like a server. Returns the report.
Result<AdvanceReport> advance_by(Simulation& simulation, std::uint64_t steps) {
  AdvanceReport total;
  for (std::uint64_t step = 0; step < steps; step += simulation.steps_per_tick()) {
    const AdvanceReport report = simulation.advance(simulation.steps_per_tick());
    if (report.failed) return describe(report.events.back(), simulation);
    total.steps += report.steps;
    total.undone_steps += report.undone_steps;
    total.device_steps += report.device_steps;
    if (report.device_error) total.device_error = report.device_error;
  }
  return total;
}

/// Running means of flow samples.
class FlowSamples {
 public:
  void add(const Diagnostics& now) {
    ++count_;
    sums_.density_error += now.mean_density_error;
    sums_.greatest_density_error += now.max_density_error;
    if (!now.volume) return;
    sums_.velocity_iterations += now.volume->velocities.iterations;
    sums_.place_iterations += now.volume->places.iterations;
  }

  FlowFigures means(const Scene& scene, bool has_liquid) const {
    const bool is_solved = scene.pressure_solver == PressureSolver::incompressible;
    const auto mean = [this](Real sum, bool present) {
      return present ? sum / static_cast<Real>(count_) : kAbsent;
    };
    return {.neighbours = kAbsent,
            .density_error = mean(sums_.density_error, has_liquid),
            .greatest_density_error = mean(sums_.greatest_density_error, has_liquid),
            .velocity_iterations = mean(sums_.velocity_iterations, has_liquid && is_solved),
            .place_iterations = mean(sums_.place_iterations, has_liquid && is_solved)};
  }

 private:
  FlowFigures sums_;
  std::uint64_t count_ = 0;
};

/// Runs an untimed repetition with diagnostics.
Result<FlowFigures> sample_flow(Simulation& simulation, std::uint64_t steps, bool has_liquid) {
  const Real neighbours_before = mean_neighbours(simulation);
  const std::uint64_t stride = (steps + kMaxSamples - 1) / kMaxSamples;
  FlowSamples samples;
  for (std::uint64_t done = 0; done < steps;) {
    const std::uint64_t part = std::min(stride, steps - done);
    const AdvanceReport report = simulation.advance(static_cast<std::uint32_t>(part));
    if (report.failed) return describe(report.events.back(), simulation);
    samples.add(simulation.diagnostics());
    done += part;
  }
  FlowFigures figures = samples.means(simulation.scene(), has_liquid);
  figures.neighbours = 0.5 * (neighbours_before + mean_neighbours(simulation));
  return figures;
}

SpeedRow describe_scene(const std::string& name, const Simulation& simulation) {
  SpeedRow row;
  row.name = name;
  row.integrator = to_string(simulation.scene().numerics.integrator);
  row.control = to_string(simulation.scene().numerics.control);
  row.particles = simulation.particle_count();
  row.springs = simulation.spring_count();
  row.instructions = simulation.instruction_set();
  for (const BodyView& body : simulation.bodies()) {
    if (body.kind == BodyKind::liquid) row.liquid_particles += body.positions.size();
  }
  if (row.liquid_particles > 0) row.solver = to_string(simulation.scene().pressure_solver);
  return row;
}

Real median_of_sorted(const std::vector<Real>& values) {
  const std::size_t middle = values.size() / 2;
  if (values.size() % 2 == 1) return values[middle];
  return 0.5 * (values[middle - 1] + values[middle]);
}

/// Repeats until the number of repetitions or the time is reached.
template <class Repeat>
Status repeat_within(const SpeedSettings& settings, Repeat&& repeat) {
  const Clock::time_point begin = Clock::now();
  for (int i = 0; i < settings.repetitions; ++i) {
    if (i > 0 && speed_seconds_since(begin) > settings.longest_time) break;
    if (Status done = repeat(); !done) return done;
  }
  return {};
}

}  // namespace

/// A scene being measured, with a row for each number of threads.
class TimedScene {
 public:
  static Result<std::unique_ptr<TimedScene>> start(const std::string& name, const Scene& scene,
                                                   const SpeedSetup& setup,
                                                   const SpeedSettings& settings) {
    auto runner = std::make_unique<SwitchRunner>(setup.threads);
    const Clock::time_point begin = Clock::now();
    Result<Simulation> created = Simulation::create(scene, runner.get(), setup.instructions);
    if (!created) return created.errors();
    const Real creation = speed_seconds_since(begin);
    Simulation& simulation = created.value();
    const Result<AdvanceReport> warmed_up =
        advance_by(simulation, speed_steps_of(simulation, settings.warm_up));
    if (!warmed_up) return warmed_up.errors();
    SpeedRow row = describe_scene(name, simulation);
    row.creation = creation;
    std::unique_ptr<TimedScene> timed(new TimedScene(std::move(runner), std::move(simulation), row,
                                                     setup.threads, settings.measured));
    DeviceChoice device = device_for(setup.device, scene);
    if (device.is_auto) device = {.is_cpu = false};
    if (device.is_cpu) return timed;
    if (Status added = timed->add_device(device, row); !added) return added.errors();
    return timed;
  }

  /// Times the scene once with each number of threads, and on the device.
  Status repeat() {
    for (std::size_t n = 0; n < rows_.size(); ++n) {
      const bool is_device = !rows_[n].device.empty();
      if (!is_device) runner_->choose(n);
      if (Status done = time_repetition(rows_[n], is_device ? *on_device_ : on_cpu_); !done) {
        return done;
      }
    }
    return {};
  }

  bool has_device() const { return on_device_.has_value(); }

  std::size_t bytes_of_snapshot() const { return bytes_of_snapshot_; }

  /// Adds the results of diagnostics and returns the rows.
  Result<std::vector<SpeedRow>> finish() {
    on_cpu_.simulation.restore(start_);
    const Result<FlowFigures> flow =
        sample_flow(on_cpu_.simulation, steps_, rows_.front().liquid_particles > 0);
    if (!flow) return flow.errors();
    if (Status same = check_hash(on_cpu_, "looked at step by step"); !same) return same.errors();
    for (SpeedRow& row : rows_) {
      row.flow = flow.value();
      std::ranges::sort(row.seconds);
    }
    return rows_;
  }

 private:
  struct Run {
    Simulation simulation;
    std::optional<std::uint64_t> hash{};  ///< after a repetition
  };

  TimedScene(std::unique_ptr<SwitchRunner> runner, Simulation simulation, const SpeedRow& row,
             const std::vector<std::size_t>& threads, Real measured)
      : runner_(std::move(runner)),
        on_cpu_{std::move(simulation)},
        rows_(threads.size(), row),
        steps_(speed_steps_of(on_cpu_.simulation, measured)),
        bytes_of_snapshot_(heap_in_use()),
        start_(on_cpu_.simulation.snapshot()) {
    bytes_of_snapshot_ = heap_in_use() - bytes_of_snapshot_;
    for (std::size_t n = 0; n < rows_.size(); ++n) rows_[n].threads = threads[n];
  }

  Status add_device(const DeviceChoice& device, SpeedRow row) {
    on_device_.emplace(Run{Simulation::from(start_, runner_.get())});
    row.device = to_text(device);
    row.threads = 0;
    rows_.push_back(std::move(row));
    return use_device(device, on_device_->simulation);
  }

  static bool all_sleep(const Simulation& simulation) {
    return simulation.sleeping_body_count() == simulation.bodies().size();
  }

  Status time_repetition(SpeedRow& row, Run& run) {
    Simulation& simulation = run.simulation;
    simulation.restore(start_);
    const Real begin_time = simulation.time();
    StageClock stages;
    simulation.set_observer(&stages);
    const Clock::time_point begin = Clock::now();
    const Result<AdvanceReport> report = advance_by(simulation, steps_);
    const Real seconds = speed_seconds_since(begin);
    simulation.set_observer(nullptr);
    if (!report) return report.errors();
    if (row.seconds.empty() || seconds < std::ranges::min(row.seconds)) {
      row.stages = stages.stages();
    }
    row.seconds.push_back(seconds);
    row.steps = std::max(report.value().steps, all_sleep(simulation) ? steps_ : 0);
    row.undone_steps = report.value().undone_steps;
    row.simulated = simulation.time() - begin_time;
    row.state_hash = simulation.state_hash();
    if (row.device.empty()) {
      return check_hash(run, "with " + std::to_string(row.threads) + " threads");
    }
    if (Status same = check_hash(run, "on " + row.device); !same) return same;
    return check_device_steps(report.value(), row.device);
  }

  /// Checks that the device has taken all steps.
  Status check_device_steps(const AdvanceReport& report, const std::string& device) const {
    if (report.device_error) return *report.device_error;
    if (report.device_steps == steps_) return {};
    return Error{"device_failed", "/device",
                 device + " has taken " + std::to_string(report.device_steps) + " of " +
                     std::to_string(steps_) + " steps"};
  }

  /// Checks that all repetitions end in one state.
  Status check_hash(Run& run, const std::string& which) {
    const std::uint64_t hash = run.simulation.state_hash();
    if (!run.hash) run.hash = hash;
    if (hash == *run.hash) return {};
    return Error{"not_deterministic", "",
                 "a run " + which + " ends in another state than the first, with " +
                     std::to_string(rows_.front().threads) + " threads"};
  }

  std::unique_ptr<SwitchRunner> runner_;
  Run on_cpu_;
  std::optional<Run> on_device_{};
  std::vector<SpeedRow> rows_;
  std::uint64_t steps_;
  std::size_t bytes_of_snapshot_;
  Snapshot start_;
};

std::string SpeedRow::arithmetic() const {
  return device.empty() ? to_string(instructions) : device;
}

Real SpeedRow::median_seconds() const {
  return median_of_sorted(seconds);
}

Real SpeedRow::median_ms_per_step() const {
  return 1e3 * median_seconds() / static_cast<Real>(steps);
}

Real SpeedRow::least_ms_per_step() const {
  return 1e3 * seconds.front() / static_cast<Real>(steps);
}

Real SpeedRow::particle_steps_per_second() const {
  return static_cast<Real>(particles) * static_cast<Real>(steps) / median_seconds();
}

Real SpeedRow::wall_per_simulated() const {
  return median_seconds() / simulated;
}

Real SpeedRow::real_time_factor() const {
  return simulated / median_seconds();
}

Result<std::vector<SpeedRow>> measure(const std::string& name, const Scene& scene,
                                      const SpeedSetup& setup, const SpeedSettings& settings) {
  const std::size_t heap_before = heap_in_use();
  const Result<std::unique_ptr<TimedScene>> timed = TimedScene::start(name, scene, setup, settings);
  if (!timed) return timed.errors();
  const auto bytes_of_simulation = [&] {
    return heap_in_use() - timed.value()->bytes_of_snapshot() - heap_before;
  };
  const Status done = repeat_within(settings, [&] { return timed.value()->repeat(); });
  if (!done) return done.errors();
  const std::size_t bytes = bytes_of_simulation();
  Result<std::vector<SpeedRow>> rows = timed.value()->finish();
  // The memory of a device on the CPU, such as PoCL, cannot be told from that of the scene.
  if (!rows || heap_before == 0 || timed.value()->has_device()) return rows;
  for (SpeedRow& row : rows.value()) {
    const auto particles = static_cast<Real>(row.particles);
    row.bytes_per_particle = static_cast<Real>(bytes) / particles;
    row.bytes_with_diagnostics = static_cast<Real>(bytes_of_simulation()) / particles;
  }
  return rows;
}

Result<std::vector<SpeedRow>> measure_in_turn(const std::vector<NamedScene>& scenes,
                                              const SpeedSetup& setup,
                                              const SpeedSettings& settings) {
  std::vector<std::unique_ptr<TimedScene>> all;
  for (const NamedScene& one : scenes) {
    Result<std::unique_ptr<TimedScene>> timed =
        TimedScene::start(one.name, one.scene, setup, settings);
    if (!timed) return timed.errors();
    all.push_back(std::move(timed).value());
  }
  const Status done = repeat_within(settings, [&]() -> Status {
    for (const auto& timed : all) {
      if (Status repeated = timed->repeat(); !repeated) return repeated;
    }
    return {};
  });
  if (!done) return done.errors();
  std::vector<SpeedRow> rows;
  for (const auto& timed : all) {
    const Result<std::vector<SpeedRow>> some = timed->finish();
    if (!some) return some.errors();
    rows.insert(rows.end(), some.value().begin(), some.value().end());
  }
  return rows;
}

}  // namespace vat::bench
