#pragma once

#include <chrono>
#include <ostream>

#include "server/support/stage_clock.h"

namespace vat {

/// Prints the stages in descending order of time, with their share of `stepping` (time of all
/// steps). The last row contains the remaining time.
void print_profile(const StageClock& profile, std::chrono::duration<double> stepping,
                   std::ostream& out);

}  // namespace vat
