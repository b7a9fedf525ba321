#pragma once

#include <cstdint>

#include "core/device/opencl/program.h"

namespace vat {

/// Counters of the kernels, in the order of state.cl.
struct Counters {
  std::int32_t faults = 0;
  std::int32_t stops = 0;
};

/// The counters of a device. The functions throw opencl::DeviceFailure.
class DeviceCounters {
 public:
  explicit DeviceCounters(opencl::Program& program)
      : buffer(program, sizeof(Counters)), program_(program) {}

  void clear() { program_.fill_with_zeros(buffer, sizeof(Counters)); }
  /// Waits for all commands, and returns the counters.
  Counters read() {
    Counters counters;
    program_.read(buffer, std::span(&counters, 1));
    return counters;
  }

  opencl::Buffer buffer;

 private:
  opencl::Program& program_;
};

}  // namespace vat
