#pragma once

#include <memory>
#include <string>

#include "core/device/opencl/devices.h"

namespace vat::opencl {

/// A program that is compiled for a device, with its context. Threads may share it.
class CompiledProgram {
 public:
  CompiledProgram(const CompiledProgram&) = delete;
  CompiledProgram& operator=(const CompiledProgram&) = delete;
  ~CompiledProgram();

  const Device& device() const { return device_; }
  cl_context context() const { return context_; }
  cl_program program() const { return program_; }

 private:
  friend class CompiledPrograms;

  CompiledProgram(const Api& api, Device device) : api_(api), device_(std::move(device)) {}
  Status build(const std::string& source, const std::string& options);

  const Api& api_;
  Device device_;
  cl_context context_ = nullptr;
  cl_program program_ = nullptr;
};

/// Number of programs that the process keeps without users.
inline constexpr std::size_t kKeptPrograms = 8;

/// Returns the program of `source` and `options` for `device`. The process compiles it once, and
/// keeps the kKeptPrograms programs that were used last. Other threads wait for a compilation.
/// Fails with the code "device_failed", the name of the driver and the log of its compiler.
Result<std::shared_ptr<const CompiledProgram>> compile_once(const Device& device,
                                                            const std::string& source,
                                                            const std::string& options);

}  // namespace vat::opencl
