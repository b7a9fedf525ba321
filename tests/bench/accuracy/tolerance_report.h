#pragma once

#include <filesystem>
#include <vector>

#include "core/support/result.h"
#include "tests/bench/report/plot.h"
#include "tests/bench/report/table.h"
#include "tests/stability/tolerance_sweep.h"

/// Run time and density error of incompressible liquids against their tolerances.
namespace vat::bench {

/// Simulates `seconds` [s] of each scene with each tolerance. Times are medians of `repetitions`.
std::vector<stability::TolerancePoint> sweep_tolerances(Real seconds, int repetitions);

Table tolerances_table(const std::vector<stability::TolerancePoint>& points);
/// Wall time against tolerance, with one line per scene.
LogPlot tolerances_plot(const std::vector<stability::TolerancePoint>& points);

/// Writes the table and the plot to `folder`.
Status write_tolerances(const std::vector<stability::TolerancePoint>& points,
                        const std::filesystem::path& folder);

}  // namespace vat::bench
