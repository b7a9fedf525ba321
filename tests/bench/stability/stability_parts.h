#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/bench/options.h"
#include "tests/bench/report/table.h"

namespace vat::bench {

/// What one part of the stability run counted.
struct StabilityCount {
  std::string part;
  std::uint64_t scenes = 0;
  std::uint64_t non_finite = 0;  ///< scenes in which a value was not finite
  std::uint64_t aborts = 0;      ///< scenes that threw
  std::uint64_t outside = 0;     ///< particles beyond walls: a fault
  std::uint64_t events = 0;      ///< of the guard, each with a step undone
  std::uint64_t retries = 0;     ///< steps and parts of steps beyond those asked for
  std::uint64_t wall_stops = 0;  ///< of particles and rigid bodies, see AdvanceReport
  std::uint64_t stopped = 0;     ///< scenes that the guard ended, as it may
  std::uint64_t refused = 0;     ///< scenes that were refused, as they must be
  std::uint64_t faults = 0;      ///< scenes, or figures, that are not as they must be
  Real seconds = 0;
};

/// Each runs one part, writes its tables and plots to the options' folder, and prints what is not
/// as it must be.
Result<StabilityCount> run_adversarial_part(const Options& options);
Result<StabilityCount> run_random_part(const Options& options);
Result<StabilityCount> run_vat_part(const Options& options);
Result<StabilityCount> run_conservation_part(const Options& options);
Result<StabilityCount> run_long_part(const Options& options);
Result<StabilityCount> run_map_part(const Options& options);

/// Prints "FAULT name: what".
void print_fault(const std::string& name, const std::string& what);

}  // namespace vat::bench
