#pragma once

#include <cstdint>
#include <string>

#include "core/simulation/simulation.h"
#include "core/support/result.h"
#include "server/output/output_file.h"

namespace vat {

/// Writes one CSV row per output time. Columns: (a list, one item per line, with "external force"
/// and "positions").
class DiagnosticsWriter {
 public:
  /// Creates the file and its header row.
  static Result<DiagnosticsWriter> create(const std::string& name, const Simulation& simulation);

  Status write(const Simulation& simulation, std::uint64_t guard_events);
  /// Completes the file. Without this call, the file name keeps the extension ".part".
  Status finish();

 private:
  explicit DiagnosticsWriter(OutputFile file);
  OutputFile file_;
};

}  // namespace vat
