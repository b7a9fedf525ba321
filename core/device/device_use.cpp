#include "core/device/device_use.h"

#include <utility>

#include "core/device/device_engine.h"
#include "core/device/opencl/devices.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Names the scene's member in errors of the device, if the scene names the device.
Errors name_in_scene(Errors errors, const DeviceChoice& device, const Simulation& simulation) {
  if (simulation.scene().numerics.device != device) return errors;
  for (Error& error : errors) {
    if (error.path == "/device") error.path = "/numerics/device";
  }
  return errors;
}

using SetEngine = Status (Simulation::*)(std::unique_ptr<StepEngine>);

Status set_device(const DeviceChoice& device, Simulation& simulation, SetEngine set_engine) {
  Result<std::unique_ptr<StepEngine>> engine = make_engine(device);
  if (!engine) return name_in_scene(engine.errors(), device, simulation);
  if (!engine.value()) return {};
  const Status set = (simulation.*set_engine)(std::move(engine).value());
  return set ? set : name_in_scene(set.errors(), device, simulation);
}

}  // namespace

Status check_device(const DeviceChoice& choice) {
  if (choice.is_cpu) return {};
  const Result<opencl::Device> device = opencl::find_device(choice.index);
  return device ? Status() : Status(device.errors());
}

Result<std::unique_ptr<StepEngine>> make_engine(const DeviceChoice& choice) {
  VAT_CHECK(!choice.is_auto);
  if (choice.is_cpu) return std::unique_ptr<StepEngine>();
  const Result<opencl::Device> device = opencl::find_device(choice.index);
  if (!device) return device.errors();
  return make_device_engine(device.value(), choice.arithmetic);
}

DeviceChoice device_for(const std::optional<DeviceChoice>& setting, const Scene& scene) {
  return setting.value_or(scene.numerics.device.value_or(DeviceChoice{}));
}

Status use_device(const DeviceChoice& device, Simulation& simulation) {
  return set_device(device, simulation, &Simulation::set_engine);
}

Status resume_device(const DeviceChoice& device, Simulation& simulation) {
  return set_device(device, simulation, &Simulation::resume_engine);
}

}  // namespace vat
