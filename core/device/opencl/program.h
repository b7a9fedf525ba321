#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/device/opencl/compiled_program.h"
#include "core/support/check.h"

/// Kernels of one device, their buffers, and the queue that runs them in order.
namespace vat::opencl {

/// A call of OpenCL has failed: the device is lost, or out of memory, or a kernel is invalid.
class DeviceFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Program;

/// A buffer of bytes on the device. It must not outlive its program.
class Buffer {
 public:
  Buffer() = default;
  /// Throws DeviceFailure if the device has no memory left.
  Buffer(const Program& program, std::size_t bytes);
  Buffer(Buffer&& other) noexcept
      : program_(other.program_),
        memory_(std::exchange(other.memory_, nullptr)),
        bytes_(other.bytes_) {}
  Buffer& operator=(Buffer&& other) noexcept {
    std::swap(program_, other.program_);
    std::swap(memory_, other.memory_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~Buffer();

  cl_mem memory() const { return memory_; }

 private:
  const Program* program_ = nullptr;
  cl_mem memory_ = nullptr;
  std::size_t bytes_ = 0;
};

class Program {
 public:
  /// Creates a queue and kernels of the program of compile_once(). Fails like compile_once().
  /// With `has_double_pairs`, arguments with a function in_single_precision() are not converted by
  /// it.
  static Result<std::unique_ptr<Program>> create(const Device& device, const std::string& source,
                                                 const std::string& options,
                                                 bool has_double_pairs = false);
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program();

  const Device& device() const { return compiled_->device(); }
  bool has_double_pairs() const { return has_double_pairs_; }

  // The functions below throw DeviceFailure. Commands run in the order of their calls.

  /// Runs the kernel `name` for `count` work-items in groups of kGroup. `arguments` are buffers and
  /// values. The last group may be incomplete, so that a kernel must compare its index with its
  /// own count.
  template <class... Arguments>
  void run(const char* name, std::size_t count, const Arguments&... arguments) {
    enqueue(name, prepare(name, arguments...), count, kGroup);
  }
  /// Runs the kernel `name` for `count` particles like run(). Each work-item computes
  /// Device::lanes particles, so that a group also has kGroup particles.
  template <class... Arguments>
  void run_in_lanes(const char* name, std::size_t count, const Arguments&... arguments) {
    enqueue(name, prepare(name, arguments...), (count + device().lanes - 1) / device().lanes,
            kGroup / device().lanes);
  }
  template <class T>
  void write(const Buffer& buffer, std::span<const T> values) {
    write_bytes(buffer, values.data(), values.size_bytes());
  }
  /// Waits for all commands. Then reads from the start of the buffer.
  template <class T>
  void read(const Buffer& buffer, std::span<T> values) {
    read_bytes(buffer, values.data(), values.size_bytes());
  }
  void copy(const Buffer& from, const Buffer& to, std::size_t bytes);
  void fill_with_zeros(const Buffer& buffer, std::size_t bytes);

  static constexpr std::size_t kGroup = 256;

 private:
  friend class Buffer;

  Program(const Api& api, std::shared_ptr<const CompiledProgram> compiled, bool has_double_pairs)
      : api_(api), compiled_(std::move(compiled)), has_double_pairs_(has_double_pairs) {}
  /// A kernel keeps the arguments of its last run, so that a missing one would not be an error.
  struct Kernel {
    std::string name;
    cl_kernel kernel;
    cl_uint arguments;
  };

  const Kernel& find_kernel(const char* name);
  /// Returns the kernel with these arguments, whose number must be that of the kernel.
  template <class... Arguments>
  cl_kernel prepare(const char* name, const Arguments&... arguments) {
    const Kernel& found = find_kernel(name);
    VAT_CHECK(found.arguments == sizeof...(arguments));
    cl_kernel kernel = found.kernel;
    cl_uint index = 0;
    (set_argument(name, kernel, index++, arguments), ...);
    return kernel;
  }
  void set_argument(const char* name, cl_kernel kernel, cl_uint index, const Buffer& buffer) {
    cl_mem memory = buffer.memory();
    set_bytes(name, kernel, index, sizeof(cl_mem), &memory);
  }
  template <class T>
  void set_argument(const char* name, cl_kernel kernel, cl_uint index, const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    if constexpr (requires { value.in_single_precision(); }) {
      if (!has_double_pairs_) {
        const auto single = value.in_single_precision();
        set_bytes(name, kernel, index, sizeof single, &single);
        return;
      }
    }
    set_bytes(name, kernel, index, sizeof value, &value);
  }
  void set_bytes(const char* name, cl_kernel kernel, cl_uint index, std::size_t size,
                 const void* bytes);
  void enqueue(const char* name, cl_kernel kernel, std::size_t items, std::size_t group);
  void write_bytes(const Buffer& buffer, const void* bytes, std::size_t size);
  void read_bytes(const Buffer& buffer, void* bytes, std::size_t size);
  void check(cl_int code, const char* action) const;

  const Api& api_;
  const std::shared_ptr<const CompiledProgram> compiled_;
  const bool has_double_pairs_;
  cl_command_queue queue_ = nullptr;
  std::vector<Kernel> kernels_;
};

}  // namespace vat::opencl
