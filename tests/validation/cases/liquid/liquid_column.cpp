#include <algorithm>
#include <cmath>

#include "tests/validation/cases.h"
#include "tests/validation/cases/liquid/liquid_fit.h"
#include "tests/validation/cases/liquid/liquid_rest.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

constexpr Real kColumnDepth = 0.5;  // uncompressed [m]
constexpr const char* kWalls =
    "the walls exert forces, but do not contribute to the density, so the density at the floor is "
    "too low";
constexpr const char* kColumnAsked = "error of the best explicit solvers with 20 layers";

/// Pressure of the gas with a speed of sound of 10 m/s.
Real gas_pressure(Real z) {
  const Real level = reference("/liquid/LIQ-3/H0=0.5,c=10/gas_height");
  return z < level ? 1e5 * std::expm1(kGravity * (level - z) / 100) : 0;
}

/// Pressure of Tait's liquid with a speed of sound of 20 m/s.
Real tait_pressure(Real z) {
  const Real level = reference("/liquid/LIQ-3/H0=0.5,c=20/tait_height");
  const Real base = 1 + 6 * kGravity * (level - z) / 400;
  return z < level ? 4e5 / 7 * (std::pow(base, 7.0 / 6) - 1) : 0;
}

/// Mean heights and pressures of the particles over the last second of a run.
struct MeanPressure {
  std::vector<Real> heights;
  std::vector<Real> pressures;
};

MeanPressure mean_pressure(Run& run, Real from, Real until) {
  MeanPressure mean;
  run.advance_to(from);
  const std::size_t count = run.body().positions.size();
  mean.heights.assign(count, 0);
  mean.pressures.assign(count, 0);
  int samples = 0;
  run.observe_until(until, 0.02, [&] {
    const BodyView body = run.body();
    const std::vector<Real> now = run.simulation().liquid_fields(body.id).value().pressure;
    for (std::size_t i = 0; i < count; ++i) {
      mean.heights[i] += body.positions[i].z();
      mean.pressures[i] += now[i];
    }
    ++samples;
  });
  for (Real& height : mean.heights) height /= samples;
  for (Real& pressure : mean.pressures) pressure /= samples;
  return mean;
}

/// Returns the relative L2 distance between the pressures and the exact ones.
Real pressure_error(const MeanPressure& mean, Real (*exact_pressure)(Real z)) {
  Real error = 0;
  Real scale = 0;
  for (std::size_t i = 0; i < mean.heights.size(); ++i) {
    const Real exact = exact_pressure(mean.heights[i]);
    error += std::pow(mean.pressures[i] - exact, 2);
    scale += exact * exact;
  }
  return std::sqrt(error / scale);
}

Real column_greatest_speed(const Run& run) {
  Real speed = 0;
  for (const Vec3& v : run.body().velocities) speed = std::max(speed, v.norm());
  return speed;
}

Scene column(int layers) {
  Scene scene = load_scene("LIQ-3");
  set_spacing(scene, kColumnDepth / layers);
  set_walls_like_liquid(scene);
  const LiquidConstants& liquid = *scene.materials[0].liquid;
  const Real viscous = 0.05 * std::pow(liquid.support_radius, 2) * 1000 / liquid.viscosity;
  return with_step(scene, std::min(acoustic_step(scene, 0.02), 0.02 / std::ceil(0.02 / viscous)));
}

void check_column(Sheet& sheet, int layers) {
  const std::string target = "published target of this method";
  const std::string of = ", " + std::to_string(layers) + " layers";
  const bool fine = layers >= 20;  // as published
  Run run = sheet.start(column(layers));
  const MeanPressure mean = mean_pressure(run, 3, 4);
  const Line found =
      fitted_line(mean.heights, mean.pressures, 0.1 * kColumnDepth, 0.8 * kColumnDepth);
  sheet.add("slope of the pressure / (-rho g)" + of, 1, -found.slope / (1000 * kGravity),
            fine ? within(0.2, target) : reported(kWalls), run);
  sheet.add("greatest speed / sqrt(g H)" + of, 0.05,
            column_greatest_speed(run) / std::sqrt(kGravity * kColumnDepth), at_most(target), run);
  sheet.add("pressure at the floor by the fitted line / (rho g H)" + of, 1,
            found.at_zero / reference("/liquid/LIQ-3/H0=0.5,c=10/gas_p_bottom"),
            fine ? within(0.2, "slope and depth") : reported(kWalls), run);
  const Real middle = run.diagnostics().bodies[0].center_of_mass.z();
  // The centre of the gas-law liquid is slightly below half of its height.
  sheet.add("twice the mean height [m]" + of, reference("/liquid/LIQ-3/H0=0.5,c=10/gas_height"),
            2 * middle, reported(kWalls), run);
  sheet.add("relative L2 error of the pressure" + of,
            reference("/measured_yardsticks/hydrostatic/mcg03 factor corrected N=20 H=2dx/L2p"),
            pressure_error(mean, gas_pressure), reported(kWalls), run);
}

void run_column_case(Sheet& sheet) {
  for (const int layers : {10, 20, 40}) {
    if (sheet.quick() && layers == 40) continue;
    check_column(sheet, layers);
  }
}

void check_tait_column(Sheet& sheet, int layers, KernelId kernel = KernelId::wendland_c2) {
  const std::string published =
      "/measured_yardsticks/hydrostatic/wcsph N=" + std::to_string(layers) + "/L2p";
  std::string of = ", " + std::to_string(layers) + " layers";
  Scene scene = load_scene("LIQ-3-tait");
  if (kernel == KernelId::cubic_spline) {
    of += ", cubic spline of 2.5 spacings";
    scene.kernel = kernel;
    scene.materials[0].liquid->support_radius = 2.5 * scene.bodies[0].spacing;
  }
  set_spacing(scene, kColumnDepth / layers);
  Run run = sheet.start(with_step(scene, acoustic_step(scene, 0.02)));
  const MeanPressure mean = mean_pressure(run, 2, 3);
  const Line found =
      fitted_line(mean.heights, mean.pressures, 0.1 * kColumnDepth, 0.8 * kColumnDepth);
  sheet.add("relative L2 error of the pressure" + of, layers == 20 ? 0.03 : reference(published),
            pressure_error(mean, tait_pressure),
            at_most(layers == 20 ? kColumnAsked : "the best explicit method elsewhere"), run);
  sheet.add("slope of the pressure / (-rho g)" + of, 1, -found.slope / (1000 * kGravity),
            within(0.01, kColumnAsked), run);
  sheet.add("pressure at the floor by the fitted line / (rho g H)" + of, 1,
            found.at_zero / reference("/liquid/LIQ-3/H0=0.5,c=20/tait_p_bottom"),
            within(0.01, kColumnAsked), run);
  sheet.add("greatest speed / sqrt(g H)" + of, 4e-3,
            column_greatest_speed(run) / std::sqrt(kGravity * kColumnDepth), at_most(kColumnAsked),
            run);
}

void run_tait_column(Sheet& sheet) {
  for (const int layers : {20, 40}) {
    if (sheet.quick() && layers == 40) continue;
    check_tait_column(sheet, layers);
  }
  check_tait_column(sheet, 20, KernelId::cubic_spline);
}

}  // namespace

std::vector<Case> liquid_column_cases() {
  return {{"LIQ-3", "liquid column at rest", "liquid", {"LIQ-3"}, run_column_case},
          {"LIQ-3-tait",
           "weakly compressible liquid column at rest",
           "liquid",
           {"LIQ-3-tait"},
           run_tait_column}};
}

}  // namespace vat::validation
