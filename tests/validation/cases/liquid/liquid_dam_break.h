#pragma once

#include <functional>
#include <vector>

#include "tests/validation/run.h"

namespace vat::validation {

/// Values over times, in Martin and Moyce's units.
struct Series {
  std::vector<Real> times;
  std::vector<Real> values;

  Real at(Real time) const;
};

struct DamBreak {
  Series front;   ///< Z = x/a over T = t sqrt(2 g/a)
  Series height;  ///< of the column, over 2a, over tau = t sqrt(g/a)
};

/// LIQ-15: the foremost and the highest of the particles at the back wall until the front is far
/// out. A particle on its own, which has a third of the rest density, is spray and no part of the
/// liquid. `observe` is called after each interval.
DamBreak watch_dam_break(Run& run, Real spacing, const std::function<void()>& observe = {});

/// RMS relative distance of the front from the experiment for T >= 0.8, whose gate has let the
/// liquid go up to 0.35 later, at the delay that fits best.
Real best_front_error(const Series& front);
/// RMS distance of the height from the experiment.
Real height_error(const Series& height);

}  // namespace vat::validation
