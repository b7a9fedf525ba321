#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace vat::stability {

/// One figure of a long run, and the bound that theory gives.
struct LongRunRow {
  std::string scene;
  std::string quantity;
  Real value = 0;
  Real bound = 0;
  std::string reason;  ///< of the bound
  std::uint64_t steps = 0;
  std::uint64_t undone = 0;
  std::uint64_t hash = 0;

  bool is_within() const { return value <= bound && undone == 0; }
};

/// The names of the scenes: oscillator, spring-cube, top, stack, pool, thin-pool.
std::vector<std::string> long_run_names();

/// Runs one of them by this many steps. Values are the greatest seen at a thousand times.
std::vector<LongRunRow> run_long(const std::string& name, std::uint64_t steps);

}  // namespace vat::stability
