#pragma once

#include <filesystem>
#include <vector>

#include "core/support/result.h"
#include "tests/bench/report/plot.h"
#include "tests/bench/report/table.h"
#include "tests/stability/accuracy_sweep.h"
#include "tests/stability/tolerance_sweep.h"

/// Cost and error against the tolerances of incompressible liquids, and against a requested
/// accuracy.
namespace vat::bench {

/// Simulates `seconds` [s] of each scene with each tolerance. Times are medians of `repetitions`.
std::vector<stability::TolerancePoint> sweep_tolerances(Real seconds, int repetitions);

Table tolerances_table(const std::vector<stability::TolerancePoint>& points);
/// Wall time against tolerance, with one line per scene.
LogPlot tolerances_plot(const std::vector<stability::TolerancePoint>& points);

/// Simulates each scene of kAccuracyScenes with each accuracy.
std::vector<stability::AccuracyPoint> sweep_accuracies();

Table accuracies_table(const std::vector<stability::AccuracyPoint>& points);
/// Evaluations and iterations against accuracy, with one line per scene.
LogPlot accuracies_plot(const std::vector<stability::AccuracyPoint>& points);

/// Writes the table and the plot to `folder`.
Status write_accuracies(const std::vector<stability::AccuracyPoint>& points,
                        const std::filesystem::path& folder);

/// Writes the table and the plot to `folder`.
Status write_tolerances(const std::vector<stability::TolerancePoint>& points,
                        const std::filesystem::path& folder);

}  // namespace vat::bench
