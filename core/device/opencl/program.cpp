#include "core/device/opencl/program.h"

#include <algorithm>

#include "core/support/check.h"

namespace vat::opencl {

Buffer::Buffer(const Program& program, std::size_t bytes) : program_(&program), bytes_(bytes) {
  VAT_CHECK(bytes > 0);
  if (bytes > program.device().greatest_buffer) {
    throw DeviceFailure(program.device().name + " has no buffers of " + std::to_string(bytes) +
                        " bytes");
  }
  cl_int code = CL_SUCCESS;
  memory_ = program.api_.create_buffer(program.compiled_->context(), CL_MEM_READ_WRITE, bytes,
                                       nullptr, &code);
  program.check(code, "the allocation of a buffer");
  *program.device().used_memory += bytes;
}

Buffer::~Buffer() {
  if (memory_ == nullptr) return;
  program_->api_.release_buffer(memory_);
  *program_->device().used_memory -= bytes_;
}

Result<std::unique_ptr<Program>> Program::create(const Device& device, const std::string& source,
                                                 const std::string& options,
                                                 bool has_double_pairs) {
  const Result<const Api*> api = load_api();
  if (!api) return api.errors();
  auto compiled = compile_once(device, source, options);
  if (!compiled) return compiled.errors();
  std::unique_ptr<Program> program(
      new Program(*api.value(), std::move(compiled).value(), has_double_pairs));
  cl_int code = CL_SUCCESS;
  program->queue_ = api.value()->create_queue(program->compiled_->context(), device.id, 0, &code);
  if (code == CL_SUCCESS) return program;
  return Error{"device_failed", "/device",
               device.name + ": no queue, OpenCL error " + std::to_string(code)};
}

Program::~Program() {
  for (const Kernel& each : kernels_) api_.release_kernel(each.kernel);
  if (queue_ != nullptr) api_.release_queue(queue_);
}

void Program::check(cl_int code, const char* action) const {
  if (code == CL_SUCCESS) return;
  throw DeviceFailure(device().name + " (" + device().driver + "): " + action +
                      " failed with OpenCL error " + std::to_string(code));
}

const Program::Kernel& Program::find_kernel(const char* name) {
  const auto found = std::ranges::find(kernels_, name, &Kernel::name);
  if (found != kernels_.end()) return *found;
  cl_int code = CL_SUCCESS;
  cl_kernel kernel = api_.create_kernel(compiled_->program(), name, &code);
  check(code, name);
  kernels_.push_back({name, kernel, 0});
  cl_uint& arguments = kernels_.back().arguments;
  check(api_.get_kernel_info(kernel, CL_KERNEL_NUM_ARGS, sizeof arguments, &arguments, nullptr),
        name);
  return kernels_.back();
}

void Program::set_bytes(const char* name, cl_kernel kernel, cl_uint index, std::size_t size,
                        const void* bytes) {
  check(api_.set_argument(kernel, index, size, bytes), name);
}

void Program::enqueue(const char* name, cl_kernel kernel, std::size_t items, std::size_t group) {
  VAT_CHECK(items > 0);
  const std::size_t whole = (items + group - 1) / group * group;
  check(api_.enqueue_kernel(queue_, kernel, 1, nullptr, &whole, &group, 0, nullptr, nullptr), name);
}

void Program::write_bytes(const Buffer& buffer, const void* bytes, std::size_t size) {
  check(api_.enqueue_write(queue_, buffer.memory(), CL_TRUE, 0, size, bytes, 0, nullptr, nullptr),
        "a copy to the device");
}

void Program::read_bytes(const Buffer& buffer, void* bytes, std::size_t size) {
  check(api_.enqueue_read(queue_, buffer.memory(), CL_TRUE, 0, size, bytes, 0, nullptr, nullptr),
        "a copy from the device");
}

void Program::copy(const Buffer& from, const Buffer& to, std::size_t bytes) {
  check(api_.enqueue_copy(queue_, from.memory(), to.memory(), 0, 0, bytes, 0, nullptr, nullptr),
        "a copy on the device");
}

void Program::fill_with_zeros(const Buffer& buffer, std::size_t bytes) {
  const cl_int zero = 0;
  check(
      api_.enqueue_fill(queue_, buffer.memory(), &zero, sizeof zero, 0, bytes, 0, nullptr, nullptr),
      "a fill");
}

}  // namespace vat::opencl
