#pragma once

#include <cstddef>

#include "core/device/opencl/program.h"
#include "core/model/model.h"
#include "core/stage/advance_report.h"

namespace vat {

/// The limit of the elongation of springs on a device, see elongation_limit.cl. The functions throw
/// opencl::DeviceFailure.
class DeviceElongation {
 public:
  /// For a model with limited springs.
  DeviceElongation(opencl::Program& program, const Model& model);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model);

  /// Changes the velocities for the following drift of `dt` [s]. `are_torn` tells which spring ends
  /// are torn; null if springs do not change.
  void limit(Real dt, const opencl::Buffer* are_torn, const opencl::Buffer& position,
             const opencl::Buffer& velocity, const opencl::Buffer& mobility);

  void clear_counts();
  /// Adds the sweeps since clear_counts() to a report.
  void count(AdvanceReport& report);

 private:
  opencl::Program& program_;
  const std::size_t colours_;
  opencl::Buffer begins_, springs_, limits_, sweeps_;
};

}  // namespace vat
