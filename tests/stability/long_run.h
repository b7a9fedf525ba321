#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace vat::stability {

/// A result of a long run, and its theoretical bound.
struct LongRunRow {
  std::string scene;
  std::string quantity;
  Real value = 0;
  Real bound = 0;
  std::string reason;  ///< reason of the bound
  std::uint64_t steps = 0;
  std::uint64_t undone = 0;
  std::uint64_t hash = 0;

  bool is_within() const { return value <= bound && undone == 0; }
};

/// Returns the names of the scenes: oscillator, spring-cube, top, stack, pool, thin-pool.
std::vector<std::string> long_run_names();

/// Runs the named scene for `steps` steps. Values are the maxima of a thousand samples.
std::vector<LongRunRow> run_long(const std::string& name, std::uint64_t steps);

}  // namespace vat::stability
