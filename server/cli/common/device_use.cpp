#include "server/cli/common/device_use.h"

#include <chrono>
#include <memory>
#include <optional>
#include <utility>

namespace vat {
namespace {

constexpr std::uint32_t kFirstSteps = 2;  // prepare buffers and kernels
constexpr std::uint32_t kTimedSteps = 4;

using Seconds = std::chrono::duration<double>;

/// Returns the time of some steps, or nothing if a step fails or the device does not take it.
std::optional<Seconds> time_of_steps(Simulation& simulation, bool is_device,
                                     const TimeSource& now) {
  const AdvanceReport first = simulation.advance(kFirstSteps);
  const auto begin = now();
  const AdvanceReport timed = simulation.advance(kTimedSteps);
  const Seconds time = now() - begin;
  if (first.failed || timed.failed) return {};
  if (is_device && timed.device_steps != kTimedSteps) return {};
  return time;
}

}  // namespace

DeviceChoice choose_device(const DeviceChoice& wanted, const Simulation& simulation,
                           TaskRunner& runner, const TimeSource& now) {
  if (!wanted.is_auto) return wanted;
  const DeviceChoice cpu;
  const DeviceChoice device{.is_cpu = false};
  Simulation on_device = Simulation::from(simulation.snapshot(), &runner);
  if (!use_device(device, on_device)) return cpu;
  const std::optional<Seconds> device_time = time_of_steps(on_device, true, now);
  if (!device_time) return cpu;
  Simulation on_cpu = Simulation::from(simulation.snapshot(), &runner);
  const std::optional<Seconds> cpu_time = time_of_steps(on_cpu, false, now);
  return cpu_time && *device_time < *cpu_time ? device : cpu;
}

Status use_device(const DeviceChoice& device, Simulation& simulation) {
  Result<std::unique_ptr<StepEngine>> engine = make_engine(device);
  if (!engine) return engine.errors();
  if (!engine.value()) return {};
  return simulation.set_engine(std::move(engine).value());
}

}  // namespace vat
