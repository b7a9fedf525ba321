#pragma once

#include <cstddef>
#include <string>

namespace vat::bench {

struct FaultOptions {
  double seconds = 600;
  double kill_every = 30;  ///< [s]
  std::size_t sessions = 20;
  std::size_t clients = 200;
  std::string program = VAT_PROGRAM;
  std::string output = VAT_SOURCE_DIR "/build/bench/faults";
};

/// Runs the soak, prints its results and its failures, and writes the results. Returns whether all
/// bounds hold. Throws std::runtime_error if the test cannot run.
bool run_fault_soak(const FaultOptions& options);

}  // namespace vat::bench
