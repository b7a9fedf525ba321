#include "tests/validation/cases/liquid/liquid_dam_break.h"

#include <algorithm>
#include <cmath>

#include "tests/validation/cases.h"
#include "tests/validation/cases/liquid/liquid_fit.h"
#include "tests/validation/cases/liquid/liquid_rest.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

constexpr Real kWidth = 0.2;  // a of Martin and Moyce; the column is 2a high [m]
const std::string kSeries = "/data_series/martin_moyce_1952/n2_2/";

Series measured_series(const char* times, const char* values) {
  return {reference_at(kSeries + times).get<std::vector<Real>>(),
          reference_at(kSeries + values).get<std::vector<Real>>()};
}

/// Returns the RMS relative distance between the front and the experiment for T >= 0.8, if the
/// experiment's gate releases the liquid `shift` later.
Real front_error(const Series& front, Real shift) {
  const Series experiment = measured_series("T_values", "Z_values");
  Real sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < experiment.times.size(); ++i) {
    if (experiment.times[i] < 0.8) continue;
    const Real z = front.at(experiment.times[i] - shift);
    sum += std::pow(z / experiment.values[i] - 1, 2);
    ++count;
  }
  return std::sqrt(sum / count);
}

}  // namespace

Real Series::at(Real time) const {
  const auto next = std::ranges::upper_bound(times, time);
  if (next == times.begin()) return values.front();
  if (next == times.end()) return values.back();
  const auto i = static_cast<std::size_t>(next - times.begin());
  const Real part = (time - times[i - 1]) / (times[i] - times[i - 1]);
  return values[i - 1] + part * (values[i] - values[i - 1]);
}

DamBreak watch_dam_break(Run& run, Real spacing, const std::function<void()>& observe) {
  DamBreak seen;
  run.observe_until(0.38, 0.005, [&] {
    if (observe) observe();
    const BodyView body = run.body();
    const std::vector<Real> density = run.simulation().liquid_fields(body.id).value().density;
    Real x = 0;
    Real z = 0;
    for (std::size_t i = 0; i < body.positions.size(); ++i) {
      if (density[i] < 500) continue;
      x = std::max(x, body.positions[i].x());
      if (body.positions[i].x() < 1.5 * spacing) z = std::max(z, body.positions[i].z());
    }
    const Real tau = run.simulation().time() * std::sqrt(kGravity / kWidth);
    seen.front.times.push_back(tau * std::sqrt(Real{2}));
    seen.front.values.push_back((x + spacing / 2) / kWidth);
    seen.height.times.push_back(tau);
    seen.height.values.push_back((z + spacing / 2) / (2 * kWidth));
  });
  return seen;
}

Real best_front_error(const Series& front) {
  Real best = front_error(front, 0);
  for (int i = 1; i <= 70; ++i) best = std::min(best, front_error(front, 0.005 * i));
  return best;
}

Real height_error(const Series& height) {
  const Series experiment = measured_series("tau_values", "H_values");
  Real sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < experiment.times.size(); ++i) {
    if (experiment.times[i] > 2.45) continue;
    sum += std::pow(height.at(experiment.times[i]) - experiment.values[i], 2);
    ++count;
  }
  return std::sqrt(sum / count);
}

namespace {

void check_dam_break(Sheet& sheet, int layers) {
  const Real spacing = kWidth / layers;
  Scene scene = load_scene("LIQ-15");
  set_spacing(scene, spacing);
  set_walls_like_liquid(scene);
  scene.materials[0].liquid->viscosity = 1000 * artificial_viscosity(scene, 0.05);
  Run run = sheet.start(with_step(scene, acoustic_step(scene, 0.005)));
  const DamBreak seen = watch_dam_break(run, spacing);
  const std::string of = ", a/dx = " + std::to_string(layers);
  const Tolerance target = within(0.04, "published target");
  const bool fine = layers >= 40;
  const std::string coarse =
      "the viscosity that stabilises the method slows the front at low resolution";
  sheet.add("RMS error of the front, experiment delayed by 0.175" + of, 0,
            front_error(seen.front, 0.175), fine ? target : reported(coarse), run);
  sheet.add("RMS error of the front, best delay up to 0.35" + of, 0, best_front_error(seen.front),
            target, run);
  sheet.add("RMS error of the front, no delay" + of, 0, front_error(seen.front, 0),
            within(reference("/measured_yardsticks/dam_break_front/mcg03 corrected a~1dx=20/"
                             "rms_noshift"),
                   "same method elsewhere"),
            run);
  sheet.add("speed of the front dZ/dT, T from 2.2 to 3.33" + of, 1.381,
            fitted_line(seen.front.times, seen.front.values, 2.2, 3.33).slope,
            reported("the experiment has friction on its floor"), run);
  sheet.add("RMS error of the height at the back" + of, 0, height_error(seen.height),
            fine ? within(0.03, "published target") : reported("the thickness of a layer is 0.025"),
            run);
}

void run_dam_break_case(Sheet& sheet) {
  check_dam_break(sheet, 20);
  if (!sheet.quick()) check_dam_break(sheet, 40);
}

void check_tait_dam_break(Sheet& sheet, int layers) {
  const Real spacing = kWidth / layers;
  Scene scene = load_scene("LIQ-15-tait");
  set_spacing(scene, spacing);
  Run run = sheet.start(with_step(scene, acoustic_step(scene, 0.005)));
  const DamBreak seen = watch_dam_break(run, spacing);
  const std::string of = ", a/dx = " + std::to_string(layers);
  const std::string asked = "error of the best explicit solvers";
  const std::string published =
      "/measured_yardsticks/dam_break_front/wcsph a~1dx=" + std::to_string(layers) + '/';
  sheet.add("RMS error of the front, best delay up to 0.35" + of, 0.015,
            best_front_error(seen.front), at_most(asked), run);
  sheet.add("RMS error of the height at the back" + of, 0.013, height_error(seen.height),
            at_most(asked), run);
  sheet.add(
      "RMS error of the front, no delay" + of, reference(published + "rms_noshift"),
      front_error(seen.front, 0),
      reported(
          "published result of the same method; the gate of the experiment opens in a finite time"),
      run);
}

void run_tait_dam_break(Sheet& sheet) {
  check_tait_dam_break(sheet, 20);
  if (!sheet.quick()) check_tait_dam_break(sheet, 40);
}

}  // namespace

std::vector<Case> liquid_dam_break_cases() {
  return {{"LIQ-15", "dam break", "liquid", {"LIQ-15"}, run_dam_break_case},
          {"LIQ-15-tait",
           "dam break of weakly compressible liquid",
           "liquid",
           {"LIQ-15-tait"},
           run_tait_dam_break}};
}

}  // namespace vat::validation
