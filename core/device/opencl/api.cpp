#include "core/device/opencl/api.h"

#include <dlfcn.h>

#include <string>

namespace vat::opencl {
namespace {

constexpr const char* kLibrary = "libOpenCL.so.1";

Error not_available(const std::string& cause) {
  return {"not_available", "/device", "OpenCL is not available: " + cause};
}

Result<Api> find_functions() {
  void* library = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return not_available(dlerror());
  Api api{};
  std::string missing;
  const auto find = [&](auto& function, const char* name) {
    void* found = dlsym(library, name);
    if (found == nullptr) missing = name;
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(found);
  };
  find(api.get_platforms, "clGetPlatformIDs");
  find(api.get_devices, "clGetDeviceIDs");
  find(api.get_device_info, "clGetDeviceInfo");
  find(api.create_context, "clCreateContext");
  find(api.release_context, "clReleaseContext");
  find(api.create_queue, "clCreateCommandQueue");
  find(api.release_queue, "clReleaseCommandQueue");
  find(api.create_buffer, "clCreateBuffer");
  find(api.release_buffer, "clReleaseMemObject");
  find(api.create_program, "clCreateProgramWithSource");
  find(api.build_program, "clBuildProgram");
  find(api.get_build_info, "clGetProgramBuildInfo");
  find(api.release_program, "clReleaseProgram");
  find(api.create_kernel, "clCreateKernel");
  find(api.get_kernel_info, "clGetKernelInfo");
  find(api.release_kernel, "clReleaseKernel");
  find(api.set_argument, "clSetKernelArg");
  find(api.enqueue_kernel, "clEnqueueNDRangeKernel");
  find(api.enqueue_write, "clEnqueueWriteBuffer");
  find(api.enqueue_read, "clEnqueueReadBuffer");
  find(api.enqueue_copy, "clEnqueueCopyBuffer");
  find(api.enqueue_fill, "clEnqueueFillBuffer");
  find(api.finish, "clFinish");
  if (!missing.empty()) return not_available(std::string(kLibrary) + " has no " + missing);
  return api;
}

}  // namespace

Result<const Api*> load_api() {
  static const Result<Api> kLoaded = find_functions();
  if (!kLoaded) return kLoaded.errors();
  return &kLoaded.value();
}

}  // namespace vat::opencl
