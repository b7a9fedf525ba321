#pragma once

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include "core/support/result.h"

namespace vat::opencl {

/// The functions of the OpenCL library of this machine.
struct Api {
  decltype(&clGetPlatformIDs) get_platforms;
  decltype(&clGetDeviceIDs) get_devices;
  decltype(&clGetDeviceInfo) get_device_info;
  decltype(&clCreateContext) create_context;
  decltype(&clReleaseContext) release_context;
  decltype(&clCreateCommandQueue) create_queue;
  decltype(&clReleaseCommandQueue) release_queue;
  decltype(&clCreateBuffer) create_buffer;
  decltype(&clReleaseMemObject) release_buffer;
  decltype(&clCreateProgramWithSource) create_program;
  decltype(&clBuildProgram) build_program;
  decltype(&clGetProgramBuildInfo) get_build_info;
  decltype(&clReleaseProgram) release_program;
  decltype(&clCreateKernel) create_kernel;
  decltype(&clGetKernelInfo) get_kernel_info;
  decltype(&clReleaseKernel) release_kernel;
  decltype(&clSetKernelArg) set_argument;
  decltype(&clEnqueueNDRangeKernel) enqueue_kernel;
  decltype(&clEnqueueWriteBuffer) enqueue_write;
  decltype(&clEnqueueReadBuffer) enqueue_read;
  decltype(&clEnqueueCopyBuffer) enqueue_copy;
  decltype(&clEnqueueFillBuffer) enqueue_fill;
  decltype(&clFinish) finish;
};

/// Loads the OpenCL library once per process. Fails with the code "not_available" if this machine
/// has no library, or an incomplete one.
Result<const Api*> load_api();

}  // namespace vat::opencl
