#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/result.h"

namespace vat::bench {

/// A small scene whose steps are counted in instructions: in one thread, with the baseline
/// instruction set.
struct CountedScene {
  std::string name;
  Scene (*make)();
  Real warm_up = 0;  ///< [s] simulated before
  Real counted = 0;  ///< [s] simulated
};

const std::vector<CountedScene>& counted_scenes();

/// What a run of a scene had in it.
struct CountedRun {
  std::uint64_t particles = 0;
  std::uint64_t steps = 0;  ///< those counted
};

/// Runs the scene; what is counted happens in a function that callgrind can be told of by
/// kCountedFunction. Fails where a step does.
Result<CountedRun> run_counted(const CountedScene& scene);
inline constexpr const char* kCountedFunction = "vat_counted_steps";

}  // namespace vat::bench
