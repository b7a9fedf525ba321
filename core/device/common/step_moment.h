#pragma once

#include "core/types.h"

namespace vat {

/// A moment of a step: the durations of its kicks and of its drift, and the time after the drift.
struct StepMoment {
  Real time = 0;  ///< [s]
  Real closing = 0;
  Real opening = 0;
  Real drift = 0;
  Real prediction = 0;
};

}  // namespace vat
