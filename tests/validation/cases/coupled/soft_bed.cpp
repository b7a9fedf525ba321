#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <stdexcept>
#include <vector>

#include "tests/validation/cases.h"

// Liquid on soft tissue: a column of liquid bounces on a bed of springs. The motion is vertical, so
// both are rods with closed-form solutions.

namespace vat::validation {

namespace {

/// The lattice of springs under pressure: columns of particles, kept apart by the vat.
struct Bed {
  Real spacing = 0;
  Real structural = 0;  ///< [N/m]
  Real shear = 0;       ///< [N/m] both diagonals of each cell
  Real floor = 0;       ///< [N/m] below each column
  Real density = 0;
  int columns = 0;
  int rows = 0;

  /// Returns the pressure [Pa] of a layer at the compressive strain e. Diagonals of length s
  /// (sqrt(2) at rest) exert shear (sqrt(2) - s) spacing, of which (1 - e)/s is vertical.
  Real pressure(Real e) const {
    const Real s = std::hypot(1 - e, 1);
    const Real diagonals = 2 * (1 - 1.0 / columns);
    return structural * e + diagonals * shear * (std::numbers::sqrt2 / s - 1) * (1 - e);
  }
  /// Returns d pressure / d e.
  Real modulus(Real e) const {
    constexpr Real kDifference = 1e-4;
    return (pressure(e + kDifference) - pressure(e - kDifference)) / (2 * kDifference);
  }
  Real strain(Real under) const {
    Real e = 0;
    for (int n = 0; n < 20; ++n) e -= (pressure(e) - under) / modulus(e);
    return e;
  }
  /// Returns the displacement of the top relative to the lowest layer, under a pressure and the
  /// bed's weight.
  Real compression(Real above) const {
    Real sum = 0;
    for (int row = 1; row < rows; ++row) {
      sum += spacing * strain(above + density * kGravity * spacing * (rows - row));
    }
    return sum;
  }
};

Bed bed_of(const Scene& scene) {
  const Material& gel = scene.materials[1];
  const BodyDescription& body = scene.bodies[1];
  const Vec3 size = std::get<BoxShape>(body.shape).size;
  return {.spacing = body.spacing,
          .structural = gel.springs->structural->stiffness,
          .shear = gel.springs->shear->stiffness,
          .floor = scene.interfaces[0].constants.stiffness,
          .density = gel.density,
          .columns = static_cast<int>(std::lround(size.x() / body.spacing)),
          .rows = static_cast<int>(std::lround(size.z() / body.spacing))};
}

/// Returns the root of an increasing function between the bounds.
template <class Function>
Real root_between(Real low, Real high, Function&& function) {
  for (int n = 0; n < 60; ++n) {
    const Real middle = (low + high) / 2;
    (function(middle) < 0 ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// Returns the period of the slowest mode of a liquid rod with a free top on a spring rod with a
/// fixed foot. At their interface, rho c tan(omega H/c) = rho' c' cot(omega T/c'). The floor's
/// springs act like modulus/floor spacings of the bed.
Real bounce_period(const Scene& scene, const Bed& bed, Real strain) {
  const Material& water = scene.materials[0];
  const Real depth = std::get<BoxShape>(scene.bodies[0].shape).size.z();
  const Real c = std::sqrt(water.liquid->stiffness);
  const Real modulus = bed.modulus(strain);
  const Real bed_c = std::sqrt(modulus / bed.density);
  const Real height = bed.spacing * (bed.rows - 1 + modulus / bed.floor);
  const Real quarter = std::min(c / depth, bed_c / height) * std::numbers::pi / 2;
  const Real omega = root_between(1e-3 * quarter, (1 - 1e-9) * quarter, [&](Real w) {
    return water.density * c * std::tan(w * depth / c) * std::tan(w * height / bed_c) -
           bed.density * bed_c;
  });
  return 2 * std::numbers::pi / omega;
}

/// Returns the mean height of a layer of the bed.
Real height_of(const BodyView& view, const Bed& bed, int row) {
  const auto columns = static_cast<std::size_t>(bed.columns);
  Real sum = 0;
  for (const Vec3& place : view.positions.subspan(static_cast<std::size_t>(row) * columns, columns))
    sum += place.z();
  return sum / bed.columns;
}

struct Bounce {
  Real period = 0;
  Real compression = 0;  ///< mean over whole periods
};

/// Whole periods lie between downward passages through the middle.
Bounce measure_bed(const std::vector<Real>& compressions, Real interval, Real middle) {
  std::vector<Real> passages;
  std::vector<std::size_t> samples;
  for (std::size_t i = 1; i < compressions.size(); ++i) {
    const Real before = compressions[i - 1];
    const Real now = compressions[i];
    if (!(before < middle && now >= middle)) continue;
    passages.push_back(interval * (static_cast<Real>(i) - (now - middle) / (now - before)));
    samples.push_back(i);
  }
  if (passages.size() < 2) throw std::runtime_error("the liquid does not bounce");
  const auto whole =
      std::span(compressions).subspan(samples.front(), samples.back() - samples.front());
  return {.period = (passages.back() - passages.front()) / static_cast<Real>(passages.size() - 1),
          .compression = std::accumulate(whole.begin(), whole.end(), Real{0}) /
                         static_cast<Real>(whole.size())};
}

void run_bed_bounce(Sheet& sheet) {
  constexpr Real kInterval = 1e-3;
  const Scene scene = load_scene("INT-9");
  const Bed bed = bed_of(scene);
  const Real depth = std::get<BoxShape>(scene.bodies[0].shape).size.z();
  const Real expected = bed.compression(scene.materials[0].density * kGravity * depth);
  const Real height = bed.spacing * (bed.rows - 1);
  Run run = sheet.start(scene);
  std::vector<Real> compressions;
  run.observe_until(sheet.quick() ? 0.8 : 2, kInterval, [&] {
    const BodyView view = run.body("bed");
    compressions.push_back(height - height_of(view, bed, bed.rows - 1) + height_of(view, bed, 0));
  });
  const Bounce bounce = measure_bed(compressions, kInterval, expected);
  // The liquid acts between the bed's top layer and the liquid's lowest layer.
  const Real place = bed.spacing / 2 / height;
  sheet.add("mean compression of the bed [m]", expected, bounce.compression,
            within_relative(place, "half a spacing of the bed's height"), run);
  sheet.add("period [s]", bounce_period(scene, bed, expected / height), bounce.period,
            within_relative(place / 2, "half of that: its square root"), run);
}

}  // namespace

std::vector<Case> soft_bed_cases() {
  return {{"INT-9",
           "weakly compressible liquid bouncing on a soft bed",
           "interaction",
           {"INT-9"},
           run_bed_bounce}};
}

}  // namespace vat::validation
