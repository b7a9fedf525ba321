#include "core/device/opencl/devices.h"

#include <algorithm>
#include <map>
#include <mutex>

namespace vat::opencl {
namespace {

template <class T>
T number_of(const Api& api, cl_device_id device, cl_device_info what) {
  T value{};
  api.get_device_info(device, what, sizeof value, &value, nullptr);
  return value;
}

std::string text_of(const Api& api, cl_device_id device, cl_device_info what) {
  std::size_t size = 0;
  if (api.get_device_info(device, what, 0, nullptr, &size) != CL_SUCCESS || size == 0) return {};
  std::string text(size, '\0');
  api.get_device_info(device, what, size, text.data(), nullptr);
  text.resize(text.find('\0'));
  return text;
}

/// Returns the counter of Device::used_memory. The caller must hold the mutex of list_devices().
std::atomic<std::uint64_t>& used_memory_of(cl_device_id id) {
  // Never destroyed, because buffers can be destroyed at the end of the process.
  static auto& counters = *new std::map<cl_device_id, std::atomic<std::uint64_t>>;
  return counters[id];
}

Device describe(const Api& api, cl_device_id id) {
  Device device;
  device.id = id;
  device.used_memory = &used_memory_of(id);
  device.name = text_of(api, id, CL_DEVICE_NAME);
  device.driver = text_of(api, id, CL_DEVICE_VENDOR) + ' ' + text_of(api, id, CL_DRIVER_VERSION);
  device.memory = number_of<cl_ulong>(api, id, CL_DEVICE_GLOBAL_MEM_SIZE);
  device.greatest_buffer = number_of<cl_ulong>(api, id, CL_DEVICE_MAX_MEM_ALLOC_SIZE);
  device.compute_units = number_of<cl_uint>(api, id, CL_DEVICE_MAX_COMPUTE_UNITS);
  const auto type = number_of<cl_device_type>(api, id, CL_DEVICE_TYPE);
  // A simulator of GPUs can have the types of both.
  const bool is_cpu = (type & (CL_DEVICE_TYPE_CPU | CL_DEVICE_TYPE_GPU)) == CL_DEVICE_TYPE_CPU;
  device.lanes = is_cpu ? kMostLanes : 1;
  device.has_doubles = number_of<cl_device_fp_config>(api, id, CL_DEVICE_DOUBLE_FP_CONFIG) != 0;
  const auto single = number_of<cl_device_fp_config>(api, id, CL_DEVICE_SINGLE_FP_CONFIG);
  constexpr cl_device_fp_config kExact =
      CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT | CL_FP_DENORM | CL_FP_ROUND_TO_NEAREST;
  device.is_exact = (single & kExact) == kExact;
  return device;
}

}  // namespace

Result<std::vector<Device>> list_devices() {
  const Result<const Api*> loaded = load_api();
  if (!loaded) return loaded.errors();
  const Api& api = *loaded.value();
  // PoCL 3.1 fails if two threads ask for its devices for the first time.
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  std::vector<Device> devices;
  cl_uint count = 0;
  if (api.get_platforms(0, nullptr, &count) != CL_SUCCESS || count == 0) return devices;
  std::vector<cl_platform_id> platforms(count);
  api.get_platforms(count, platforms.data(), nullptr);
  for (cl_platform_id platform : platforms) {
    cl_uint device_count = 0;
    api.get_devices(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &device_count);
    std::vector<cl_device_id> ids(device_count);
    if (device_count == 0) continue;
    api.get_devices(platform, CL_DEVICE_TYPE_ALL, device_count, ids.data(), nullptr);
    for (cl_device_id id : ids) devices.push_back(describe(api, id));
  }
  return devices;
}

Result<Device> find_device(std::size_t index) {
  const Result<std::vector<Device>> devices = list_devices();
  if (!devices) return devices.errors();
  if (index >= devices.value().size()) {
    return Error{"not_available", "/device",
                 "opencl:" + std::to_string(index) + " does not exist; this machine has " +
                     std::to_string(devices.value().size()) + " OpenCL devices"};
  }
  const Device& device = devices.value()[index];
  if (!device.has_doubles) {
    return Error{"not_available", "/device",
                 device.name + " has no arithmetic in double precision"};
  }
  return device;
}

}  // namespace vat::opencl
