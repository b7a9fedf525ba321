#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/bench/options.h"
#include "tests/bench/report/table.h"

namespace vat::bench {

/// The counts of one part of the stability run.
struct StabilityCount {
  std::string part;
  std::uint64_t scenes = 0;
  std::uint64_t non_finite = 0;  ///< scenes with a non-finite value
  std::uint64_t aborts = 0;      ///< scenes that threw an exception
  std::uint64_t outside = 0;     ///< particles beyond walls: a fault
  std::uint64_t events = 0;      ///< events of the guard, each with an undone step
  std::uint64_t retries = 0;     ///< steps and parts of steps beyond the requested ones
  std::uint64_t wall_stops = 0;  ///< of particles and rigid bodies, see AdvanceReport
  std::uint64_t stopped = 0;     ///< scenes that the guard ended, as permitted
  std::uint64_t refused = 0;     ///< scenes that were refused, as required
  std::uint64_t faults = 0;      ///< scenes or figures that violate a condition
  Real seconds = 0;
};

/// Each function runs one part, writes its tables and plots to the options' folder, and prints
/// violations.
Result<StabilityCount> run_adversarial_part(const Options& options);
Result<StabilityCount> run_random_part(const Options& options);
Result<StabilityCount> run_vat_part(const Options& options);
Result<StabilityCount> run_conservation_part(const Options& options);
Result<StabilityCount> run_long_part(const Options& options);
Result<StabilityCount> run_map_part(const Options& options);

/// Prints "FAULT name: what".
void print_fault(const std::string& name, const std::string& what);

}  // namespace vat::bench
