#pragma once

#include <vector>

#include "tests/bench/report/plot.h"
#include "tests/bench/speed/measure.h"

namespace vat::bench {

/// Wall time of a particle and step against the number of particles: the dam breaks of each solver
/// by their threads.
LogPlot size_plot(const std::vector<SpeedRow>& rows);

/// How much faster the dam breaks are with more threads than with one.
LogPlot thread_plot(const std::vector<SpeedRow>& rows);

}  // namespace vat::bench
