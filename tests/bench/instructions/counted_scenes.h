#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/result.h"

namespace vat::bench {

/// A small scene for counting the instructions of its steps, in one thread with the baseline
/// instruction set.
struct CountedScene {
  std::string name;
  Scene (*make)();
  Real warm_up = 0;  ///< [s] simulated before the count
  Real counted = 0;  ///< [s] simulated
};

const std::vector<CountedScene>& counted_scenes();

/// Result of a counted run.
struct CountedRun {
  std::uint64_t particles = 0;
  std::uint64_t steps = 0;  ///< number of counted steps
};

/// Runs the scene. The counted steps are inside the function kCountedFunction. Fails if a step
/// fails.
Result<CountedRun> run_counted(const CountedScene& scene);
inline constexpr const char* kCountedFunction = "vat_counted_steps";

}  // namespace vat::bench
