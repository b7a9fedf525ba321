#include "core/device/opencl/program.h"

#include <algorithm>

#include "core/support/check.h"

namespace vat::opencl {

Buffer::Buffer(const Program& program, std::size_t bytes) : program_(&program) {
  VAT_CHECK(bytes > 0);
  if (bytes > program.device_.greatest_buffer) {
    throw DeviceFailure(program.device_.name + " has no buffers of " + std::to_string(bytes) +
                        " bytes");
  }
  cl_int code = CL_SUCCESS;
  memory_ = program.api_.create_buffer(program.context_, CL_MEM_READ_WRITE, bytes, nullptr, &code);
  program.check(code, "the allocation of a buffer");
}

Buffer::~Buffer() {
  if (memory_ != nullptr) program_->api_.release_buffer(memory_);
}

Result<std::unique_ptr<Program>> Program::create(const Device& device, const char* source,
                                                 const std::string& options) {
  const Result<const Api*> api = load_api();
  if (!api) return api.errors();
  std::unique_ptr<Program> program(new Program(*api.value(), device));
  if (Status built = program->build(source, options); !built) return built.errors();
  return program;
}

Status Program::build(const char* source, const std::string& options) {
  const auto failed = [&](const std::string& what) {
    return Error{"device_failed", "/device", device_.name + " (" + device_.driver + "): " + what};
  };
  cl_int code = CL_SUCCESS;
  context_ = api_.create_context(nullptr, 1, &device_.id, nullptr, nullptr, &code);
  if (code != CL_SUCCESS) return failed("no context, OpenCL error " + std::to_string(code));
  queue_ = api_.create_queue(context_, device_.id, 0, &code);
  if (code != CL_SUCCESS) return failed("no queue, OpenCL error " + std::to_string(code));
  program_ = api_.create_program(context_, 1, &source, nullptr, &code);
  if (code != CL_SUCCESS) return failed("no program, OpenCL error " + std::to_string(code));
  code = api_.build_program(program_, 1, &device_.id, options.c_str(), nullptr, nullptr);
  if (code == CL_SUCCESS) return {};
  std::size_t size = 0;
  api_.get_build_info(program_, device_.id, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size);
  std::string log(size, '\0');
  api_.get_build_info(program_, device_.id, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr);
  return failed("the kernels do not compile, OpenCL error " + std::to_string(code) + "\n" + log);
}

Program::~Program() {
  for (const auto& [name, kernel] : kernels_) api_.release_kernel(kernel);
  if (program_ != nullptr) api_.release_program(program_);
  if (queue_ != nullptr) api_.release_queue(queue_);
  if (context_ != nullptr) api_.release_context(context_);
}

void Program::check(cl_int code, const char* action) const {
  if (code == CL_SUCCESS) return;
  throw DeviceFailure(device_.name + " (" + device_.driver + "): " + action +
                      " failed with OpenCL error " + std::to_string(code));
}

cl_kernel Program::find_kernel(const char* name) {
  const auto found = std::ranges::find(kernels_, name, &std::pair<std::string, cl_kernel>::first);
  if (found != kernels_.end()) return found->second;
  cl_int code = CL_SUCCESS;
  cl_kernel kernel = api_.create_kernel(program_, name, &code);
  check(code, name);
  kernels_.emplace_back(name, kernel);
  return kernel;
}

void Program::set_bytes(const char* name, cl_kernel kernel, cl_uint index, std::size_t size,
                        const void* bytes) {
  check(api_.set_argument(kernel, index, size, bytes), name);
}

void Program::enqueue(const char* name, cl_kernel kernel, std::size_t count) {
  VAT_CHECK(count > 0);
  const std::size_t whole = (count + kGroup - 1) / kGroup * kGroup;
  check(api_.enqueue_kernel(queue_, kernel, 1, nullptr, &whole, &kGroup, 0, nullptr, nullptr),
        name);
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
