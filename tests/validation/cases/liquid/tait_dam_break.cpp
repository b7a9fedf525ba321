#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/validation/cases.h"
#include "tests/validation/cases/liquid/liquid_rest.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

// LIQ-16.

const std::string kExperiment = "/data_series/spheric_test_2/";
constexpr const char* kTaitDamAsked = "error of the best explicit solvers";

/// Returns particles that fill the box of a body, with a number that follows from its spacing.
ParticleShape fill(const BoxShape& box, Real spacing, Real density) {
  const Eigen::Array3i counts = (box.size.array() / spacing).round().cast<int>();
  const Vec3 cell = box.size.array() / counts.cast<Real>();
  ParticleShape shape;
  for (int x = 0; x < counts.x(); ++x) {
    for (int y = 0; y < counts.y(); ++y) {
      for (int z = 0; z < counts.z(); ++z) {
        const Vec3 place = Vec3(x, y, z) + Vec3::Constant(0.5);
        shape.positions.push_back(box.center - box.size / 2 + cell.cwiseProduct(place));
      }
    }
  }
  shape.masses.assign(shape.positions.size(), density * cell.prod());
  return shape;
}

Scene tank(Real spacing) {
  Scene scene = load_scene("LIQ-16");
  BodyDescription& water = scene.bodies[0];
  scene.materials[0].liquid->support_radius *= spacing / water.spacing;
  water.spacing = spacing;
  water.shape = fill(std::get<BoxShape>(water.shape), spacing, 1000);
  // Whole layers in the box, with at most 1.02 times the liquid's spacing.
  const Real edge = std::get<BoxShape>(scene.bodies[1].shape).size.x();
  scene.bodies[1].spacing = edge / std::ceil(edge / (1.02 * spacing));
  return with_step(scene, acoustic_step(scene, 0.0025));
}

/// Returns the height of the liquid at a gauge in the tank's middle: the volume of nearby particles
/// per ground area. The weights make the result independent of the gauge's position in a lattice.
Real gauge(const Run& run, Real x, Real spacing) {
  const BodyView water = run.body("water");
  const auto weight = [&](Real distance) {
    return std::max(Real{0}, 1 - std::abs(distance) / (2 * spacing)) / (2 * spacing);
  };
  Real height = 0;
  for (std::size_t i = 0; i < water.positions.size(); ++i) {
    const Vec3& place = water.positions[i];
    height += water.masses[i] / 1000 * weight(place.x() - x) * weight(place.y() - 0.5);
  }
  return height;
}

/// Returns the mean pressure of the particles within two spacings of the sensor P1 on the face of
/// the box.
Real pressure_at_box(const Run& run, Real spacing) {
  const Vec3 sensor(0.8245, 0.471, 0.021);
  const BodyView water = run.body("water");
  const std::vector<Real> pressure = run.simulation().liquid_fields(water.id).value().pressure;
  Real sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < water.positions.size(); ++i) {
    if ((water.positions[i] - sensor).norm() > 2 * spacing) continue;
    sum += pressure[i];
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

/// Returns the first time at which the pressure at the box exceeds half of the experiment's peak
/// [s].
Real half_peak_time(Run& run, Real spacing) {
  constexpr Real kInterval = 0.0025;
  const Real half = reference(kExperiment + "events/P1_peak") / 2;
  Real before = 0;
  for (int i = 1; i * kInterval <= 0.6; ++i) {
    run.advance_to(i * kInterval);
    const Real after = pressure_at_box(run, spacing);
    if (after >= half) return kInterval * (i - (after - half) / (after - before));
    before = after;
  }
  throw std::runtime_error("the liquid does not push the box");
}

struct Gauge {
  const char* name;
  std::size_t column;  ///< column of the experiment's series
  Real x;              ///< [m]
};

/// Returns the mean difference between the gauges' heights and the experiment over six seconds,
/// relative to its maximum.
std::vector<Real> height_errors(Run& run, const std::vector<Gauge>& gauges, Real spacing) {
  std::vector<Real> sums(gauges.size(), 0);
  std::vector<Real> greatest(gauges.size(), 0);
  const Json& series = reference_at(kExperiment + "series_0p1s");  // one row per 0.1 s
  for (std::size_t row = 0; row < series.size(); ++row) {
    run.advance_to(0.1 * static_cast<Real>(row));
    for (std::size_t i = 0; i < gauges.size(); ++i) {
      const Real measured = series.at(row).at(gauges[i].column).get<Real>();
      sums[i] += std::abs(gauge(run, gauges[i].x, spacing) - measured);
      greatest[i] = std::max(greatest[i], measured);
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sums[i] /= static_cast<Real>(series.size()) * greatest[i];
  }
  return sums;
}

void check_tank(Sheet& sheet, Real spacing) {
  const Scene scene = tank(spacing);
  Run start = sheet.start(scene);
  const std::string of = ", " + std::to_string(start.body("water").positions.size()) + " particles";
  sheet.add("time of half the pressure's peak at P1 [s]" + of,
            reference(kExperiment + "events/t_P1_half_peak"), half_peak_time(start, spacing),
            sheet.quick() ? reported("the front is thinner than a few of these spacings")
                          : within_relative(0.04, kTaitDamAsked),
            start);
  if (sheet.quick()) return;
  const std::vector<Gauge> gauges{{"H2", 10, 0.992}, {"H4", 12, 2.638}};
  Run run = sheet.start(scene);
  const std::vector<Real> errors = height_errors(run, gauges, spacing);
  for (std::size_t i = 0; i < gauges.size(); ++i) {
    sheet.add(std::string("mean error of the height / maximum height, ") + gauges[i].name + of,
              0.06, errors[i], at_most(kTaitDamAsked), run);
  }
}

void run_tank(Sheet& sheet) {
  if (sheet.quick()) return check_tank(sheet, 0.08);
  check_tank(sheet, 0.04);
  check_tank(sheet, 0.029);
}

}  // namespace

std::vector<Case> tait_dam_break_cases() {
  return {{"LIQ-16", "dam break against a box", "liquid", {"LIQ-16"}, run_tank}};
}

}  // namespace vat::validation
