#include "tests/bench/accuracy/growth_report.h"

#include "core/support/check.h"
#include "tests/bench/report/quantile.h"

namespace vat::bench {

std::vector<GrowthResult> sweep_growth(Index steps, int repetitions) {
  VAT_CHECK(steps > 0 && repetitions > 0);
  std::vector<GrowthResult> results;
  for (const stability::GrowthFamily& family : stability::growth_families()) {
    for (const int size : family.sizes) {
      GrowthResult result{&family, {}};
      std::vector<double> seconds;
      for (int n = 0; n < repetitions; ++n) {
        result.point = stability::measure_growth(family, size, steps);
        seconds.push_back(result.point.seconds);
      }
      result.point.seconds = median(std::move(seconds));
      results.push_back(result);
    }
  }
  return results;
}

Table growth_table(const std::vector<GrowthResult>& results) {
  Table table{{"solve", "size", "value", "particles", "iterations per step", "time of a step [us]"},
              {}};
  for (const auto& [family, point] : results) {
    table.rows.push_back({std::string(family->name), std::string(family->size),
                          static_cast<std::uint64_t>(point.size), point.particles, point.iterations,
                          1e6 * point.seconds});
  }
  return table;
}

LogPlot growth_plot(const std::vector<GrowthResult>& results) {
  LogPlot plot{.title = "Iterations of the solves of a step",
               .x_label = "size, relative to the smallest one",
               .y_label = "iterations per step",
               .series = {}};
  for (const auto& [family, point] : results) {
    if (plot.series.empty() || plot.series.back().label != family->name) {
      plot.series.push_back({.label = family->name, .points = {}, .colour = plot.series.size()});
    }
    if (point.iterations == 0) continue;
    const double size = static_cast<double>(point.size) / family->sizes.front();
    plot.series.back().points.push_back({size, point.iterations});
  }
  return plot;
}

Status write_growth(const std::vector<GrowthResult>& results, const std::filesystem::path& folder) {
  const Status done =
      write_table(growth_table(results), folder, "growth", "# Iterations of the solves of a step");
  return done ? write_plot(growth_plot(results), folder, "growth") : done;
}

}  // namespace vat::bench
