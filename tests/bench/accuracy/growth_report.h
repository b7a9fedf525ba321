#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "tests/bench/report/plot.h"
#include "tests/bench/report/table.h"
#include "tests/stability/growth_sweep.h"

/// Iterations and time of the solves of a step against the size of the problem.
namespace vat::bench {

struct GrowthResult {
  const stability::GrowthFamily* family = nullptr;
  stability::GrowthPoint point;
};

/// Measures `steps` steps of every size of every family. Times are medians of `repetitions`.
std::vector<GrowthResult> sweep_growth(Index steps, int repetitions);

Table growth_table(const std::vector<GrowthResult>& results);
/// Iterations per step against the size relative to the smallest one, with one line per family.
LogPlot growth_plot(const std::vector<GrowthResult>& results);

/// Writes the table and the plot to `folder`.
Status write_growth(const std::vector<GrowthResult>& results, const std::filesystem::path& folder);

}  // namespace vat::bench
