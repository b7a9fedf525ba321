#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace vat {

/// When a run stops for output, in whole steps.
struct Schedule {
  Real step = 0;  ///< [s]
  std::uint64_t steps_per_output = 0;
  std::uint64_t total_steps = 0;
  std::vector<std::string> notices;  ///< where the user's wishes could not be met to the letter

  /// Outputs at t = 0, at each multiple of the interval and at the end.
  std::uint64_t output_count() const;
};

/// The step is the wanted one if the output interval and the end are whole numbers of it (to 1e-9,
/// and then it is not touched, so that the result does not depend on the interval); otherwise it is
/// shortened until they are. Where that takes less than a tenth of it, the end is rounded to whole
/// steps instead. All in [s]; `until` may be 0.
Schedule make_schedule(Real wanted_step, Real every, Real until);

/// The scene's numerics with another step; the tick is changed only where it has to be to remain a
/// whole number of steps.
Numerics with_step(const Numerics& numerics, Real step);

}  // namespace vat
