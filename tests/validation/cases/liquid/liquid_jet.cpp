#include <cmath>

#include "tests/validation/cases.h"

namespace vat::validation {

namespace {

constexpr Real kSpeed = 2;         // nozzle speed [m/s]
constexpr Real kArea = 0.1 * 0.1;  // opening area: 5 x 5 spacings [m^2]
const Vec3 kOpening(0.2, 0.25, 0.8);
constexpr Real kSpacing = 0.02;

/// Returns the height of the jet's centre at x, from the particles within half a spacing.
Real height_at(const Run& run, Real x) {
  Real sum = 0;
  int count = 0;
  for (const Vec3& place : run.body("water").positions) {
    if (std::abs(place.x() - x) > kSpacing / 2) continue;
    sum += place.z();
    ++count;
  }
  return sum / count;
}

/// Returns the mean height of the jet at x, over the time in which a few layers pass.
Real mean_height(Run& run, Real x) {
  Real sum = 0;
  int samples = 0;
  run.observe_until(run.simulation().time() + 0.1, 0.005, [&] {
    sum += height_at(run, x);
    ++samples;
  });
  return sum / samples;
}

void run_jet(Sheet& sheet) {
  Run run = sheet.start(load_scene("LIQ-20"));
  run.advance_to(0.5);
  const std::uint64_t before = run.diagnostics().emitted_particles;
  const std::uint64_t drained = run.diagnostics().drained_particles;
  run.advance_to(sheet.quick() ? 1.5 : 4.5);
  const Diagnostics now = run.diagnostics();
  const Real time = now.time - 0.5;
  const Real volume = kSpacing * kSpacing * kSpacing;
  sheet.add("volume flow in [m3/s]", kSpeed * kArea,
            static_cast<Real>(now.emitted_particles - before) * volume / time,
            within_relative(1e-12, "whole layers in whole intervals"), run);
  // The drain removes whole layers, so the time is known to one layer.
  sheet.add("volume flow out [m3/s]", kSpeed * kArea,
            static_cast<Real>(now.drained_particles - drained) * volume / time,
            within(25 * volume / time, "a layer"), run);
  const auto present = static_cast<Real>(run.simulation().particle_count());
  sheet.add("particles at the start + emitted - drained",
            1 + static_cast<Real>(now.emitted_particles) - static_cast<Real>(now.drained_particles),
            present, within(0, "counted"), run);
  for (const Real x : {0.4, 0.6, 0.8}) {
    const Real fall = (x - kOpening.x()) / kSpeed;
    sheet.add("height of the jet at x = " + std::to_string(x).substr(0, 3) + " m [m]",
              kOpening.z() - kGravity / 2 * fall * fall, mean_height(run, x),
              within(kSpacing / 4, "a quarter of a spacing"), run);
  }
}

}  // namespace

std::vector<Case> liquid_jet_cases() {
  return {{"LIQ-20", "jet from a nozzle", "liquid", {"LIQ-20"}, run_jet}};
}

}  // namespace vat::validation
