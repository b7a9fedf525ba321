#pragma once

#include <memory>
#include <optional>

#include "core/scene/device_choice.h"
#include "core/simulation/simulation.h"
#include "core/stepping/step_engine.h"

namespace vat {

/// Fails like opencl::find_device() if the choice names a device that the machine lacks.
Status check_device(const DeviceChoice& choice);

/// Returns the engine of the device, or null for the CPU. The choice must not be automatic. Fails
/// like opencl::find_device() and make_device_engine().
Result<std::unique_ptr<StepEngine>> make_engine(const DeviceChoice& choice);

/// Returns the device for a scene: the setting if present, otherwise the device that the scene
/// names, otherwise the CPU.
DeviceChoice device_for(const std::optional<DeviceChoice>& setting, const Scene& scene);

/// Takes the following steps of a new simulation on a device. Fails like make_engine() and
/// Simulation::set_engine(), and changes nothing. Has no effect for the CPU. The choice must not be
/// automatic. If the scene names the device, errors of the device have the path of this name.
Status use_device(const DeviceChoice& device, Simulation& simulation);

/// Continues a loaded simulation on its device; see Simulation::resume_engine(). Otherwise like
/// use_device().
Status resume_device(const DeviceChoice& device, Simulation& simulation);

}  // namespace vat
