#pragma once

#include <vector>

#include "tests/bench/report/plot.h"
#include "tests/bench/speed/measure.h"

namespace vat::bench {

/// Returns a plot of wall time per particle and step against the number of particles, for the dam
/// breaks of each solver and number of threads.
LogPlot size_plot(const std::vector<SpeedRow>& rows);

/// Returns a plot of the dam breaks' speed-up with several threads.
LogPlot thread_plot(const std::vector<SpeedRow>& rows);

}  // namespace vat::bench
