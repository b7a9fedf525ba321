#pragma once

#include <chrono>
#include <ostream>

#include "server/stage_clock.h"

namespace vat {

/// Table of the stages by falling time, with their share of `stepping` (all time spent in steps)
/// and a row for what no stage accounts for.
void print_profile(const StageClock& profile, std::chrono::duration<double> stepping,
                   std::ostream& out);

}  // namespace vat
