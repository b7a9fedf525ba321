#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/validation/cases.h"
#include "tests/validation/order.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

constexpr Real kLatticeSpacing = 0.1;  // of all these scenes [m]
constexpr Real kDensity = 1000;

void set_support(Scene& scene, const std::string& over_spacing) {
  scene.materials[0].liquid->support_radius = std::stod(over_spacing) * kLatticeSpacing;
}

// LIQ-1.

/// A lattice, given by the points of its unit cell.
struct Cell {
  const char* name;
  std::vector<Vec3> points;
};

std::vector<Cell> cells() {
  return {{"sc", {{0, 0, 0}}},
          {"bcc", {{0, 0, 0}, {0.5, 0.5, 0.5}}},
          {"fcc", {{0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}}}};
}

/// A periodic world of 8^3 cells. The volume of each particle is kLatticeSpacing^3.
Scene lattice_scene(const Cell& cell) {
  constexpr int kCells = 8;
  Scene scene = load_scene("LIQ-1");
  const Real edge = kLatticeSpacing * std::cbrt(static_cast<Real>(cell.points.size()));
  ParticleShape shape;
  for (int x = 0; x < kCells; ++x) {
    for (int y = 0; y < kCells; ++y) {
      for (int z = 0; z < kCells; ++z) {
        for (const Vec3& point : cell.points) {
          shape.positions.push_back(edge * (Vec3(x, y, z) + point));
        }
      }
    }
  }
  scene.bodies[0].shape = shape;
  scene.periodic->max = Vec3::Constant(kCells * edge);
  return scene;
}

void run_sums(Sheet& sheet) {
  for (const Cell& cell : cells()) {
    for (const char* reach : {"1.5", "1.8", "2.0", "2.5", "3.0", "4.0"}) {
      Scene scene = lattice_scene(cell);
      set_support(scene, reach);
      const Run run = sheet.start(scene);
      const LiquidFields fields = run.simulation().liquid_fields(run.body().id).value();
      sheet.add(std::string("density / rest density, ") + cell.name + ", H/dx = " + reach,
                reference(std::string("/liquid/LIQ-1/table/") + cell.name + '/' + reach + "/poly6"),
                fields.density[0] / kDensity, within(1e-11, "round-off"), run);
    }
  }
}

// LIQ-2.

/// A periodic world as long as a wave of `count` spacings, and two support radii wide.
Scene wave_scene(const std::string& name, int count, const std::string& reach) {
  Scene scene = load_scene(name);
  set_support(scene, reach);
  const int across = 2 * static_cast<int>(std::ceil(std::stod(reach)));
  const Vec3 size = kLatticeSpacing * Vec3(count, across, across);
  scene.periodic->max = size;
  scene.bodies[0].shape = BoxShape{size / 2, size};
  return scene;
}

Real wave_number(int count) {
  return 2 * std::numbers::pi / (count * kLatticeSpacing);
}

/// Returns the amplitude of sin(k x) of values at undisturbed lattice positions.
template <class Value>
Real amplitude(const std::vector<Vec3>& places, Real k, const Value& value) {
  Real sum = 0;
  for (std::size_t i = 0; i < places.size(); ++i) sum += value(i) * std::sin(k * places[i].x());
  return 2 * sum / static_cast<Real>(places.size());
}

std::vector<Vec3> lattice_places(Scene scene) {
  scene.bodies[0].displacement_field.reset();
  const Run run(scene);
  const std::span<const Vec3> places = run.body().positions;
  return {places.begin(), places.end()};
}

/// Returns the amplitude of the density for a wave in the masses.
Real smoothed_wave(Sheet& sheet, int count, const std::string& reach, Row& row) {
  constexpr Real kWave = 0.1;
  Scene scene = wave_scene("LIQ-1", count, reach);
  const Real k = wave_number(count);
  ParticleShape shape;
  for (const Vec3& place : lattice_places(scene)) {
    const Real mass = kDensity * kLatticeSpacing * kLatticeSpacing * kLatticeSpacing;
    shape.positions.push_back(place);
    shape.masses.push_back(mass * (1 + kWave * std::sin(k * place.x())));
  }
  scene.bodies[0].shape = shape;
  const Run run = sheet.start(scene);
  row.state_hash = run.state_hash();
  const LiquidFields fields = run.simulation().liquid_fields(run.body().id).value();
  return amplitude(shape.positions, k, [&](std::size_t i) { return fields.density[i]; }) /
         (kWave * kDensity);
}

void run_interpolation(Sheet& sheet) {
  for (const char* reach : {"2.0", "3.0"}) {
    std::vector<Real> errors;
    for (const int count : {10, 20, 40, 80}) {
      Row row{.metric = "amplitude of a smoothed wave of " + std::to_string(count) +
                        " spacings, H/dx = " + reach,
              .reference = reference(std::string("/liquid/LIQ-2/table/poly6/") + reach + '/' +
                                     std::to_string(count) + "/amplitude"),
              .tolerance = within(1e-11, "round-off")};
      row.measured = smoothed_wave(sheet, count, reach, row);
      const Real sum = reference(std::string("/liquid/LIQ-1/table/sc/") + reach + "/poly6");
      errors.push_back(std::abs(row.measured / sum - 1));
      sheet.add(row);
    }
    sheet.add({.metric = std::string("order of convergence of the ratio wave / lattice sum, "
                                     "H/dx = ") +
                         reach,
               .reference = 2,
               .measured = observed_order({1.0 / 20, 1.0 / 40, 1.0 / 80},
                                          {errors[1], errors[2], errors[3]}),
               .tolerance = within(0.2, "order of smoothing, kappa H^2/2 f''")});
  }
}

// LIQ-4.

/// Returns the order of convergence from the values at three successively halved spacings.
Real order_of_approach(Real coarse, Real middle, Real fine) {
  return std::log2((middle - coarse) / (fine - middle));
}

/// Returns omega / (c k) of a sound wave of `count` spacings.
Real sound_frequency(Sheet& sheet, int count, const std::string& reach, Row& row) {
  const Real k = wave_number(count);
  const Real step = 0.2 * kLatticeSpacing / 10;  // c = 10 m/s
  Scene scene = with_step(wave_scene("LIQ-4", count, reach), step);
  PlaneWave& wave = scene.bodies[0].displacement_field->waves[0];
  wave.wave_vector.x() = k;
  // Slightly denser than at rest, so that the pressure is positive in the troughs too.
  const Real background = 2 * k * wave.amplitude.x();
  const std::vector<Vec3> places = lattice_places(scene);
  scene.bodies[0].mass = (1 + background) * kDensity * std::pow(kLatticeSpacing, 3) *
                         static_cast<Real>(places.size()) /
                         reference("/liquid/LIQ-1/table/sc/" + reach + "/poly6");
  Run run = sheet.start(scene);
  const Real interval = step * std::round(count / 2.0);  // one tenth of a period
  std::vector<Real> samples;
  run.observe_until(15 * interval, interval, [&] {
    const std::span<const Vec3> now = run.body().positions;
    samples.push_back(
        amplitude(places, k, [&](std::size_t i) { return (now[i] - places[i]).x(); }));
  });
  row.seconds += run.seconds();
  row.state_hash = run.state_hash();
  const Real omega = fitted_frequency(samples, interval);
  const Real z = omega * step;
  return omega / (1 + z * z / 24) /
         (10 * k);  // corrected for the frequency error of velocity Verlet
}

void run_sound(Sheet& sheet) {
  for (const char* reach : {"2.0", "3.0"}) {
    std::vector<Real> found;
    for (const int count : {10, 20, 40, 80}) {
      if (sheet.quick() && count == 80) continue;
      // The published operator has half of the pressure force: see core/REFERENCES.md.
      Row row{
          .metric = "omega/(c k), wave of " + std::to_string(count) + " spacings, H/dx = " + reach,
          .reference = std::sqrt(Real{2}) * reference(std::string("/liquid/LIQ-4/table/mcg03/") +
                                                      reach + '/' + std::to_string(count)),
          .tolerance = within(1e-5, "amplitude and background pressure, 1e-6, and the fit")};
      row.measured = sound_frequency(sheet, count, reach, row);
      found.push_back(row.measured);
      sheet.add(row);
    }
    sheet.add(
        {.metric =
             std::string("order of convergence of omega in spacings per wave, H/dx = ") + reach,
         .reference = 2,
         .measured = order_of_approach(found[found.size() - 3], found[found.size() - 2],
                                       found[found.size() - 1]),
         .tolerance = within(0.2, "order of smoothing, kappa H^2/2 f''")});
  }
}

// LIQ-5.

/// Returns the viscosity from the decay of a shear wave of `count` spacings, relative to that of
/// the material.
Real shear_viscosity(Sheet& sheet, const std::string& name, int count, const std::string& reach,
                     Row& row) {
  const Real k = wave_number(count);
  const Real step = 0.01;
  const Real support = std::stod(reach) * kLatticeSpacing;
  // Well below the stability limit, and slow enough for a Runge-Kutta error of 1e-7.
  const Real nu = 0.05 * std::min(support * support, 1 / (k * k)) / step;
  Scene scene = with_step(wave_scene(name, count, reach), step);
  scene.materials[0].liquid->viscosity = nu * kDensity;
  scene.bodies[0].velocity_field->waves[0].wave_vector.x() = k;
  const std::vector<Vec3> places = lattice_places(scene);
  Run run = sheet.start(scene);
  const auto speed = [&] {
    const std::span<const Vec3> now = run.body().velocities;
    return amplitude(places, k, [&](std::size_t i) { return now[i].y(); });
  };
  const Real before = speed();
  const Real time = 20 * step;
  run.advance_to(time);
  row.seconds += run.seconds();
  row.state_hash = run.state_hash();
  return std::log(before / speed()) / (nu * k * k * time);
}

void run_shear(Sheet& sheet) {
  for (const char* reach : {"2.0", "3.0", "4.0"}) {
    std::vector<Real> found;
    for (const int count : {10, 20, 40, 80}) {
      if (sheet.quick() && count == 80) continue;
      Row row{.metric = "viscosity measured / set, wave of " + std::to_string(count) +
                        " spacings, H/dx = " + reach,
              .reference = reference(std::string("/liquid/LIQ-5/table/mcg_visc_poly6_rho/") +
                                     reach + '/' + std::to_string(count)),
              .tolerance = within(1e-6, "(rate dt)^4/120 of Runge-Kutta, and round-off")};
      row.measured = shear_viscosity(sheet, "LIQ-5", count, reach, row);
      found.push_back(row.measured);
      sheet.add(row);
    }
    sheet.add({.metric = std::string("order of convergence of the viscosity in spacings per wave, "
                                     "H/dx = ") +
                         reach,
               .reference = 2,
               .measured = order_of_approach(found[found.size() - 3], found[found.size() - 2],
                                             found[found.size() - 1]),
               .tolerance = within(0.2, "order of smoothing, kappa H^2/2 f''")});
  }
}

/// Returns the ratio for the published central form with Wendland's kernel. The weakly compressible
/// liquid scales the kernel's gradient so that a linear profile on a lattice is exact. Without the
/// scaling, the factor is the speed ratio of long sound waves times the lattice's density.
Real published_shear(const std::string& reach, int count) {
  const std::string sound = "/liquid/LIQ-4/table/wendlandC2_var/" + reach + '/';
  const Real long_wave =
      reference(sound + "80") + (reference(sound + "80") - reference(sound + "40")) / 3;
  const Real slope = long_wave * reference("/liquid/LIQ-1/table/sc/" + reach + "/wendlandC2");
  return reference("/liquid/LIQ-5/table/monaghan10_wendlandC2/" + reach + '/' +
                   std::to_string(count)) /
         slope;
}

void run_tait_shear(Sheet& sheet) {
  for (const char* reach : {"2.0", "3.0", "4.0"}) {
    const Real softening = 0.01 * std::pow(std::stod(reach) / 2, 2);
    for (const int count : {10, 20, 40}) {
      Row row{.metric = "viscosity measured / set, wave of " + std::to_string(count) +
                        " spacings, H/dx = " + reach,
              .reference = published_shear(reach, count),
              .tolerance =
                  within_relative(softening / (1 + softening),
                                  "0.01 (H/2)^2 that the published form lacks, on x^2 >= dx^2")};
      row.measured = shear_viscosity(sheet, "LIQ-5-tait", count, reach, row);
      sheet.add(row);
    }
  }
}

}  // namespace

std::vector<Case> liquid_lattice_cases() {
  return {{"LIQ-1", "lattice sums of the density kernel", "liquid", {"LIQ-1"}, run_sums},
          {"LIQ-2", "interpolation of a wave", "liquid", {"LIQ-1"}, run_interpolation},
          {"LIQ-4", "sound wave", "liquid", {"LIQ-4"}, run_sound},
          {"LIQ-5", "shear wave", "liquid", {"LIQ-5"}, run_shear},
          {"LIQ-5-tait",
           "shear wave in a weakly compressible liquid",
           "liquid",
           {"LIQ-5-tait"},
           run_tait_shear}};
}

}  // namespace vat::validation
