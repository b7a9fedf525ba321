#include "server/operations/choose_device.h"

#include <optional>

#include "core/device/device_use.h"

namespace vat {
namespace {

constexpr std::uint32_t kFirstSteps = 2;  // prepare buffers and kernels
constexpr std::uint32_t kTimedSteps = 4;

using WallTime = std::chrono::duration<double>;

/// Returns the time of some steps, or nothing if a step fails or the device does not take it.
std::optional<WallTime> time_of_steps(Simulation& simulation, bool is_device,
                                      const TimeSource& now) {
  const AdvanceReport first = simulation.advance(kFirstSteps);
  const auto begin = now();
  const AdvanceReport timed = simulation.advance(kTimedSteps);
  const WallTime time = now() - begin;
  if (first.failed || timed.failed) return {};
  if (is_device && timed.device_steps != kTimedSteps) return {};
  return time;
}

}  // namespace

DeviceChoice choose_device(const DeviceChoice& wanted, const Simulation& simulation,
                           TaskRunner& runner, const TimeSource& now) {
  if (!wanted.is_auto) return wanted;
  const DeviceChoice cpu;
  if (simulation.particle_count() < kLeastForDevice) return cpu;
  const DeviceChoice device{.is_cpu = false};
  Simulation on_device = Simulation::from(simulation.snapshot(), &runner);
  if (!use_device(device, on_device)) return cpu;
  const std::optional<WallTime> device_time = time_of_steps(on_device, true, now);
  if (!device_time) return cpu;
  Simulation on_cpu = Simulation::from(simulation.snapshot(), &runner);
  const std::optional<WallTime> cpu_time = time_of_steps(on_cpu, false, now);
  return cpu_time && *device_time < *cpu_time ? device : cpu;
}

}  // namespace vat
