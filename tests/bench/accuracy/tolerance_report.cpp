#include "tests/bench/accuracy/tolerance_report.h"

#include "core/support/check.h"
#include "tests/bench/report/quantile.h"

namespace vat::bench {

namespace {

using stability::AccuracyPoint;
using stability::TolerancePoint;

TolerancePoint measure_median(const char* scene, Real tolerance, Real seconds, int repetitions) {
  VAT_CHECK(repetitions > 0);
  std::vector<double> times;
  TolerancePoint point;
  for (int n = 0; n < repetitions; ++n) {
    point = stability::measure_tolerance(scene, tolerance, seconds);
    times.push_back(point.seconds);
  }
  point.seconds = median(std::move(times));
  return point;
}

}  // namespace

std::vector<TolerancePoint> sweep_tolerances(Real seconds, int repetitions) {
  std::vector<TolerancePoint> points;
  for (const char* scene : stability::kToleranceScenes) {
    for (const Real tolerance : stability::all_tolerances()) {
      points.push_back(measure_median(scene, tolerance, seconds, repetitions));
    }
  }
  return points;
}

Table tolerances_table(const std::vector<TolerancePoint>& points) {
  Table table{{"scene", "tolerance", "failed", "density error", "steps",
               "iterations for velocities", "iterations for positions", "seconds"},
              {}};
  for (const TolerancePoint& point : points) {
    table.rows.push_back({point.scene, point.tolerance, std::uint64_t{point.failed},
                          point.density_error, point.steps, point.velocity_iterations,
                          point.position_iterations, point.seconds});
  }
  return table;
}

LogPlot tolerances_plot(const std::vector<TolerancePoint>& points) {
  LogPlot plot{.title = "Tolerances of incompressible liquids",
               .x_label = "both tolerances",
               .y_label = "wall time per simulated second [s], median of the runs",
               .series = {}};
  for (const char* scene : stability::kToleranceScenes) {
    Series series{.label = scene, .points = {}, .colour = plot.series.size()};
    for (const TolerancePoint& point : points) {
      if (point.scene == scene) series.points.push_back({point.tolerance, point.seconds});
    }
    plot.series.push_back(series);
  }
  return plot;
}

std::vector<AccuracyPoint> sweep_accuracies() {
  std::vector<AccuracyPoint> points;
  for (const char* scene : stability::kAccuracyScenes) {
    for (const Real accuracy : stability::all_accuracies()) {
      points.push_back(stability::measure_accuracy(scene, accuracy));
    }
  }
  return points;
}

Table accuracies_table(const std::vector<AccuracyPoint>& points) {
  Table table{{"scene", "accuracy", "failed", "error", "steps", "evaluations", "iterations"}, {}};
  for (const AccuracyPoint& point : points) {
    table.rows.push_back({point.scene, point.accuracy, std::uint64_t{point.failed}, point.error,
                          point.steps, point.evaluations, point.iterations});
  }
  return table;
}

LogPlot accuracies_plot(const std::vector<AccuracyPoint>& points) {
  LogPlot plot{.title = "Requested accuracy",
               .x_label = "accuracy",
               .y_label = "evaluations of the forces and iterations of solves",
               .series = {}};
  for (const char* scene : stability::kAccuracyScenes) {
    Series series{.label = scene, .points = {}, .colour = plot.series.size()};
    for (const AccuracyPoint& point : points) {
      if (point.scene == scene) {
        series.points.push_back({point.accuracy, static_cast<Real>(point.work())});
      }
    }
    plot.series.push_back(series);
  }
  return plot;
}

Status write_accuracies(const std::vector<AccuracyPoint>& points,
                        const std::filesystem::path& folder) {
  const Status done =
      write_table(accuracies_table(points), folder, "accuracies", "# Requested accuracy");
  return done ? write_plot(accuracies_plot(points), folder, "accuracies") : done;
}

Status write_tolerances(const std::vector<TolerancePoint>& points,
                        const std::filesystem::path& folder) {
  const Status done = write_table(tolerances_table(points), folder, "tolerances",
                                  "# Tolerances of incompressible liquids");
  return done ? write_plot(tolerances_plot(points), folder, "tolerances") : done;
}

}  // namespace vat::bench
