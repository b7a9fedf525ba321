#pragma once

#include <chrono>
#include <functional>

#include "core/device/device_choice.h"
#include "core/simulation/simulation.h"

namespace vat {

using TimeSource = std::function<std::chrono::steady_clock::time_point()>;

/// Returns `wanted`, unless it is automatic. Then returns the first device if it computes the next
/// steps of the simulation in less time than the CPU, and otherwise the CPU. The measurement takes
/// some steps of copies of the simulation, first on the device. It asks `now` before and after
/// these steps.
DeviceChoice choose_device(const DeviceChoice& wanted, const Simulation& simulation,
                           TaskRunner& runner,
                           const TimeSource& now = std::chrono::steady_clock::now);

/// Takes the following steps of a simulation on a device. Fails like make_engine() and
/// Simulation::set_engine(), and changes nothing. Has no effect for the CPU. The choice must not be
/// automatic.
Status use_device(const DeviceChoice& device, Simulation& simulation);

}  // namespace vat
