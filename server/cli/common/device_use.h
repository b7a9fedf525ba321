#pragma once

#include "core/device/device_choice.h"
#include "core/simulation/simulation.h"

namespace vat {

/// Returns `wanted`, unless it is automatic. Then returns the first device if it computes the next
/// steps of the simulation in less time than the CPU, and otherwise the CPU. The measurement takes
/// some steps of copies of the simulation.
DeviceChoice choose_device(const DeviceChoice& wanted, const Simulation& simulation,
                           TaskRunner& runner);

/// Takes the following steps of a simulation on a device. Fails like make_engine() and
/// Simulation::set_engine(), and changes nothing. Has no effect for the CPU. The choice must not be
/// automatic.
Status use_device(const DeviceChoice& device, Simulation& simulation);

}  // namespace vat
