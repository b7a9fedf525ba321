#pragma once

#include <cstdint>
#include <string>

#include "core/simulation/simulation.h"
#include "core/support/result.h"
#include "protocol/files/output_file.h"

namespace vat {

/// Writer of one CSV row of diagnostics per output time. The first columns contain the time and the
/// values of the whole simulation. For each body, further columns contain mass, centre of mass,
/// momenta, external force and torque, and (if available) orientation and angular velocity.
class DiagnosticsWriter {
 public:
  /// Creates the file with its header row.
  static Result<DiagnosticsWriter> create(const std::string& name, const Simulation& simulation);

  Status write(const Simulation& simulation, std::uint64_t guard_events);
  /// Completes the file. Without this call, the file name has the extension ".part".
  Status finish();

 private:
  explicit DiagnosticsWriter(OutputFile file);
  OutputFile file_;
};

}  // namespace vat
