// Maps of the largest stable step.

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/limits.h"
#include "tests/bench/report/plot.h"
#include "tests/bench/stability/stability_parts.h"
#include "tests/stability/maps/projection_map.h"
#include "tests/stability/maps/step_map.h"

namespace vat::bench {
namespace {

using stability::LinearCase;
using stability::StepMapPoint;

constexpr IntegratorId kIntegrators[] = {
    IntegratorId::explicit_euler, IntegratorId::symplectic_euler, IntegratorId::velocity_verlet,
    IntegratorId::heun, IntegratorId::runge_kutta_4};
constexpr Real kMinPart = 0.95;  // relative to theory

/// Returns whether some steps are stable and others are not.
bool has_limit(const StepMapPoint& point) {
  return point.theory > 0 && std::isfinite(point.theory);
}

Table map_table(const std::vector<StepMapPoint>& points) {
  Table table{{"body", "integrator", "stiffness [N/m]", "mass ratio", "damping ratio",
               "frequency [rad/s]", "theory [s]", "measured [s]", "measured / theory"},
              {}};
  for (const StepMapPoint& point : points) {
    table.rows.push_back({point.body, std::string(to_string(point.integrator)), point.stiffness,
                          point.mass_ratio, point.damping_ratio, point.frequency, point.theory,
                          point.measured,
                          has_limit(point) ? point.measured / point.theory
                                           : std::numeric_limits<Real>::quiet_NaN()});
  }
  return table;
}

/// Returns the index of `name` in `names`. Adds it if it is missing.
std::size_t map_place_of(const std::string& name, std::vector<std::string>& names) {
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  names.push_back(name);
  return names.size() - 1;
}

/// Returns a field for each damping ratio and body. If points share a field, it shows the minimum.
GridPlot grid_of(const std::vector<StepMapPoint>& points, IntegratorId integrator) {
  GridPlot plot;
  plot.title = std::string("Largest stable step over theory: ") + to_string(integrator);
  plot.x_label = "damping ratio";
  plot.y_label = "body, mass ratio";
  plot.value_label = "measured / theory";
  plot.min = 0.9;
  plot.max = 1.1;
  for (const StepMapPoint& point : points) {
    if (std::isinf(point.theory)) continue;
    map_place_of(short_text(point.damping_ratio), plot.x_names);
    map_place_of(point.body + ", " + short_text(point.mass_ratio), plot.y_names);
  }
  plot.values.assign(plot.y_names.size(),
                     std::vector<Real>(plot.x_names.size(), std::numeric_limits<Real>::infinity()));
  for (const StepMapPoint& point : points) {
    if (point.integrator != integrator || !has_limit(point)) continue;
    Real& value =
        plot.values[map_place_of(point.body + ", " + short_text(point.mass_ratio), plot.y_names)]
                   [map_place_of(short_text(point.damping_ratio), plot.x_names)];
    value = std::min(value, point.measured / point.theory);
  }
  return plot;
}

/// Returns omega dt of the oscillator by damping ratio and integrator.
GridPlot limits_of(const std::vector<StepMapPoint>& points) {
  GridPlot plot;
  plot.title = "Largest stable omega dt of a damped oscillator";
  plot.x_label = "damping ratio";
  plot.y_label = "integrator";
  plot.value_label = "omega dt";
  plot.max = 3;
  for (const IntegratorId integrator : kIntegrators) {
    plot.y_names.emplace_back(to_string(integrator));
    plot.values.emplace_back();
  }
  for (const StepMapPoint& point : points) {
    if (point.body != "oscillator") continue;
    const std::size_t x = map_place_of(short_text(point.damping_ratio), plot.x_names);
    std::vector<Real>& row = plot.values[map_place_of(to_string(point.integrator), plot.y_names)];
    row.resize(std::max(row.size(), x + 1));
    row[x] = point.measured * point.frequency;
  }
  return plot;
}

LogPlot measured_against_theory(const std::vector<StepMapPoint>& points) {
  LogPlot plot{"Largest stable step", "theory [s]", "measured [s]", {}};
  Series line{"theory", {}, 0, 0, true};
  for (std::size_t i = 0; i < std::size(kIntegrators); ++i) {
    Series series{to_string(kIntegrators[i]), {}, i, 0, false};
    for (const StepMapPoint& point : points) {
      if (point.integrator != kIntegrators[i] || !has_limit(point)) continue;
      series.points.push_back({point.theory, point.measured});
      line.points.push_back({point.theory, point.theory});
    }
    std::ranges::sort(series.points);
    plot.series.push_back(std::move(series));
  }
  std::ranges::sort(line.points);
  plot.series.insert(plot.series.begin(), std::move(line));
  return plot;
}

/// Returns the field of these names. Missing fields are added as infinite, which shows as empty.
Real& field_of(const std::string& x_name, const std::string& y_name, GridPlot& plot) {
  const std::size_t x = map_place_of(x_name, plot.x_names);
  const std::size_t y = map_place_of(y_name, plot.y_names);
  plot.values.resize(plot.y_names.size());
  std::vector<Real>& row = plot.values[y];
  row.resize(plot.x_names.size(), std::numeric_limits<Real>::infinity());
  return row[x];
}

/// Returns the longest stable step of implicit springs, relative to the longest tried step, by
/// stiffness and body. If points share a field, it shows the minimum.
GridPlot implicit_grid_of(const std::vector<StepMapPoint>& points) {
  GridPlot plot{.title = "Longest stable step over the longest tried",
                .x_label = "stiffness [N/m]",
                .y_label = "body, mass ratio",
                .value_label = "stable / tried",
                .x_names = {},
                .y_names = {},
                .values = {}};
  for (const StepMapPoint& point : points) {
    if (!std::isinf(point.theory)) continue;
    Real& value = field_of(short_text(point.stiffness),
                           point.body + ", " + short_text(point.mass_ratio), plot);
    value = std::min(value, point.measured / stability::longest_tried_step(point.frequency));
  }
  return plot;
}

/// Returns the number of digits in the balls' distances that overlaps leave, by step, integrator
/// and mass ratio, for the points that stability needs. Fields without overlap are empty.
GridPlot projection_grid_of(const std::vector<stability::ProjectionPoint>& points) {
  GridPlot plot{.title = "A stack of balls by projection: overlap, in diameters",
                .x_label = "step [s]",
                .y_label = "integrator, mass ratio",
                .value_label = "-log10(overlap)",
                .x_names = {},
                .y_names = {},
                .values = {},
                .min = 3,
                .max = 9};
  for (const stability::ProjectionPoint& point : points) {
    field_of(short_text(point.step),
             std::string(to_string(point.integrator)) + ", " + short_text(point.mass_ratio), plot) =
        -std::log10(point.overlap);
  }
  return plot;
}

Status write_maps(const std::vector<StepMapPoint>& points, const Options& options) {
  Status written =
      write_table(map_table(points), options.output, "step-map", "# The largest stable step");
  for (const IntegratorId integrator : kIntegrators) {
    if (!written) return written;
    const bool has_any = std::ranges::any_of(points, [&](const StepMapPoint& point) {
      return point.integrator == integrator && has_limit(point);
    });
    if (has_any) {
      written = write_plot(grid_of(points, integrator), options.output,
                           std::string("step-map-") + to_string(integrator));
    }
  }
  if (!written) return written;
  written = write_plot(limits_of(points), options.output, "step-limits");
  if (!written) return written;
  written = write_plot(measured_against_theory(points), options.output, "step-map");
  if (!written) return written;
  return write_plot(implicit_grid_of(points), options.output, "implicit-map");
}

Status write_projections(const std::vector<stability::ProjectionPoint>& points,
                         const Options& options) {
  Table table{{"integrator", "mass ratio", "step [s]", "energy gained / fall", "overlap / diameter",
               "kinetic energy / fall", "stable"},
              {}};
  for (const stability::ProjectionPoint& point : points) {
    table.rows.push_back({std::string(to_string(point.integrator)), point.mass_ratio, point.step,
                          point.energy_gain, point.overlap, point.kinetic_energy,
                          stability::is_stable(point)});
  }
  Status written = write_table(table, options.output, "projection-map", "# A stack by projection");
  if (!written) return written;
  return write_plot(projection_grid_of(points), options.output, "projection-map");
}

/// Projection contacts have no step limit: every step must be stable.
std::vector<stability::ProjectionPoint> run_projections(const Options& options,
                                                        StabilityCount& count) {
  std::vector<stability::ProjectionPoint> points;
  for (const stability::ProjectionPoint& point : stability::projection_points(options.quick)) {
    ++count.scenes;
    points.push_back(stability::measure_projection(point));
    if (stability::is_stable(points.back())) continue;
    ++count.faults;
    print_fault("stack by projection, " + std::string(to_string(point.integrator)) +
                    ", mass ratio " + short_text(point.mass_ratio),
                "step of " + short_text(point.step) + " s");
  }
  return points;
}

}  // namespace

Result<StabilityCount> run_map_part(const Options& options) {
  StabilityCount count;
  std::vector<StepMapPoint> points;
  for (const LinearCase& linear : stability::linear_cases(options.quick)) {
    ++count.scenes;
    for (const IntegratorId integrator : kIntegrators) {
      if (std::isinf(stability::theoretical_step(linear, integrator))) continue;
      points.push_back(stability::map_point(linear, integrator));
      const StepMapPoint& point = points.back();
      const bool good =
          point.theory > 0 ? point.measured >= kMinPart * point.theory : point.measured == 0;
      if (good) continue;
      ++count.faults;
      print_fault(point.body + ", " + to_string(integrator) + ", damping ratio " +
                      short_text(point.damping_ratio),
                  short_text(point.measured) + " s of " + short_text(point.theory) + " s");
    }
  }
  for (const LinearCase& linear : stability::implicit_cases(options.quick)) {
    ++count.scenes;
    points.push_back(map_point_without_limit(linear, IntegratorId::velocity_verlet));
    const StepMapPoint& point = points.back();
    if (point.measured == kMaxStep || point.measured * point.frequency >= 1e4) continue;
    ++count.faults;
    print_fault(point.body + ", damping ratio " + short_text(point.damping_ratio),
                short_text(point.measured) + " s, where no step should be too long");
  }
  Status written = write_maps(points, options);
  if (written) written = write_projections(run_projections(options, count), options);
  if (!written) return written.errors();
  return count;
}

}  // namespace vat::bench
