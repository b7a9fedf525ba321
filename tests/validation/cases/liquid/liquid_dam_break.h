#pragma once

#include <functional>
#include <vector>

#include "tests/validation/run.h"

namespace vat::validation {

/// A time series in Martin and Moyce's units.
struct Series {
  std::vector<Real> times;
  std::vector<Real> values;

  Real at(Real time) const;
};

struct DamBreak {
  Series front;   ///< Z = x/a over T = t sqrt(2 g/a)
  Series height;  ///< height of the column, divided by 2a, over tau = t sqrt(g/a)
};

/// Runs LIQ-15 until the front is far out. Records the foremost particle and the highest particle
/// at the back wall. A single particle, which has a third of the rest density, is spray and
/// excluded. Calls `observe` after each interval.
DamBreak watch_dam_break(Run& run, Real spacing, const std::function<void()>& observe = {});

/// Returns the RMS relative distance between the front and the experiment for T >= 0.8. The gate
/// may release the liquid up to 0.35 later, with the best-fitting delay.
Real best_front_error(const Series& front);
/// Returns the RMS distance between the height and the experiment.
Real height_error(const Series& height);

}  // namespace vat::validation
