#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/validation/cases.h"
#include "tests/validation/cases/liquid/liquid_rest.h"

namespace vat::validation {

namespace {

constexpr Real kSlot = 0.1;         // between the faces of the plates; five spacings [m]
constexpr Real kOutletWidth = 0.8;  // tank width [m]

/// Returns the area of liquid above the plates [m^2].
Real area_left(const Run& run) {
  const BodyView water = run.body("water");
  const auto above =
      std::ranges::count_if(water.positions, [](const Vec3& x) { return x.z() > 0; });
  return static_cast<Real>(above) * water.masses[0] / 1000;
}

/// Advances until the liquid above the plates is `depth` deep. Returns the time [s].
Real time_at_depth(Run& run, Real depth) {
  while (area_left(run) > depth * kOutletWidth) {
    if (run.simulation().time() > 10) throw std::runtime_error("the tank does not run out");
    run.advance_to(run.simulation().time() + 0.01);
  }
  return run.simulation().time();
}

/// Returns the time in which a jet as wide as the slot, with the speed sqrt(2 g h), lowers the
/// depth from `from` to `to`.
Real ideal_time(Real from, Real to) {
  return kOutletWidth / kSlot * std::sqrt(2 / 9.81) * (std::sqrt(from) - std::sqrt(to));
}

void run_outlet(Sheet& sheet) {
  Scene scene = load_scene("LIQ-11");
  set_rest_mass(scene);
  scene.materials[0].liquid->viscosity = 1000 * artificial_viscosity(scene, 0.05);
  Run run = sheet.start(with_step(scene, acoustic_step(scene, 0.01)));
  // The start of the flow takes some time, and at the end the depth equals the slot width.
  const Real begin = time_at_depth(run, 0.3);
  const Real coefficient = ideal_time(0.3, 0.15) / (time_at_depth(run, 0.15) - begin);
  sheet.add("coefficient of discharge of a slot of five spacings",
            std::numbers::pi / (std::numbers::pi + 2), coefficient,
            within_relative(0.1, "half of one of the five spacings"), run);
}

}  // namespace

std::vector<Case> liquid_outlet_cases() {
  return {{"LIQ-11", "tank with a hole", "liquid", {"LIQ-11"}, run_outlet}};
}

}  // namespace vat::validation
