#pragma once

#include <chrono>
#include <cstddef>
#include <functional>

#include "core/scene/device_choice.h"
#include "core/simulation/simulation.h"

namespace vat {

using TimeSource = std::function<std::chrono::steady_clock::time_point()>;

/// Returns `wanted`, unless it is automatic. Then returns the first device if it computes the next
/// steps of the simulation in less time than the CPU, and otherwise the CPU. The measurement takes
/// some steps of copies of the simulation, first on the device. It asks `now` before and after
/// these steps. A simulation with fewer than kLeastForDevice particles is not measured, and returns
/// the CPU.
DeviceChoice choose_device(const DeviceChoice& wanted, const Simulation& simulation,
                           TaskRunner& runner,
                           const TimeSource& now = std::chrono::steady_clock::now);

/// One core computes a step of fewer particles in less than 0.3 ms.
inline constexpr std::size_t kLeastForDevice = 1000;

}  // namespace vat
