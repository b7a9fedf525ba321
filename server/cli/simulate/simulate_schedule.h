#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace vat {

/// Times of output, in whole steps.
struct Schedule {
  Real step = 0;  ///< [s]
  std::uint64_t steps_per_output = 0;
  std::uint64_t total_steps = 0;
  std::vector<std::string> notices;  ///< deviations from the requested schedule

  /// Number of outputs: at t = 0, at each multiple of the interval, and at the end.
  std::uint64_t output_count() const;
};

/// Returns a schedule whose output interval and end are whole numbers of steps. Uses the wanted
/// step if it fits (to 1e-9), so that the result does not depend on the interval; otherwise
/// shortens it. If less than a tenth would remain, rounds the end to whole steps instead. All in
/// [s]; `until` may be 0.
Schedule make_schedule(Real wanted_step, Real every, Real until);

/// Returns the numerics with another step. Changes the tick only if it would not be a whole number
/// of steps.
Numerics with_step(const Numerics& numerics, Real step);

}  // namespace vat
