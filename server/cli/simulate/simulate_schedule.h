#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/numerics.h"

namespace vat {

/// Output times, as whole numbers of steps.
struct Schedule {
  Real step = 0;  ///< [s]
  std::uint64_t steps_per_output = 0;
  std::uint64_t total_steps = 0;
  std::vector<std::string> notices;  ///< deviations from the requested schedule

  /// Returns the number of outputs: at t = 0, at each multiple of the interval, and at the end.
  std::uint64_t output_count() const;
};

/// Returns a schedule whose output interval and end are whole numbers of steps. All arguments are
/// in [s], and `until` may be 0. Uses the wanted step if both times are multiples of the step (to
/// 1e-9). Otherwise shortens the step. Rounds the end to whole steps if the step would be shorter
/// than a tenth of the wanted step.
Schedule make_schedule(Real wanted_step, Real every, Real until);

/// Returns the numerics with another step. Changes the tick only if the tick would not be a whole
/// number of steps.
Numerics with_step(const Numerics& numerics, Real step);

}  // namespace vat
