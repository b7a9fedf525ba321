#include "tests/bench/speed/plots.h"

#include <algorithm>
#include <string>

namespace vat::bench {

namespace {

constexpr const char* kScaledCase = "dam-break-";

/// Returns the series with this label. Adds it with a new colour and dash if it is missing.
Series& series_of(LogPlot& plot, const std::string& label, std::size_t colour, std::size_t dash) {
  const auto found = std::ranges::find(plot.series, label, &Series::label);
  if (found != plot.series.end()) return *found;
  return plot.series.emplace_back(Series{label, {}, colour, dash});
}

std::size_t dash_of(const SpeedRow& row) {
  return row.solver == "incompressible" ? 1 : 0;
}

}  // namespace

LogPlot size_plot(const std::vector<SpeedRow>& rows) {
  LogPlot plot{"Dam breaks: time of a step", "particles", "ns per particle and step", {}, "%g"};
  for (const SpeedRow& row : rows) {
    if (!row.name.starts_with(kScaledCase)) continue;
    const std::string threads =
        std::to_string(row.threads) + (row.threads == 1 ? " thread" : " threads");
    const std::string label = row.solver + ", " + (row.device.empty() ? threads : row.device);
    const Real particles = static_cast<Real>(row.particles);
    series_of(plot, label, row.threads, dash_of(row))
        .points.push_back({particles, 1e6 * row.median_ms_per_step() / particles});
  }
  return plot;
}

LogPlot thread_plot(const std::vector<SpeedRow>& rows) {
  LogPlot plot{"Dam breaks: speed-up by threads", "threads", "times as fast as with one", {}, "%g"};
  std::size_t colour = 0;
  for (const SpeedRow& one : rows) {
    if (!one.name.starts_with(kScaledCase) || one.threads != 1) continue;
    Series& series =
        series_of(plot, one.name.substr(std::string(kScaledCase).size()), colour++, dash_of(one));
    for (const SpeedRow& row : rows) {
      if (row.name != one.name || !row.device.empty()) continue;
      series.points.push_back(
          {static_cast<Real>(row.threads), one.median_seconds() / row.median_seconds()});
    }
  }
  return plot;
}

}  // namespace vat::bench
