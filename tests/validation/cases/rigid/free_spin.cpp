#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/validation/cases.h"
#include "tests/validation/convergence.h"
#include "tests/validation/order.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

const std::string kDumbbell = "/deformable/DEF-6a/";
const std::string kCube = "/deformable/DEF-6b/";

Real length(const Run& run) {
  const BodyView body = run.body();
  return (body.positions[1] - body.positions[0]).norm();
}

void run_dumbbell(Sheet& sheet) {
  const Scene scene = load_scene("DEF-6a");
  const Real expected = reference(kDumbbell + "L");
  Run run = sheet.start(with_method(scene, IntegratorId::velocity_verlet, 1e-3));
  sheet.add("energy at the start [J]", reference(kDumbbell + "energy"), run.energy(),
            within_relative(1e-14, "round-off"), run);
  Real greatest = 0;
  run.observe_until(10, 1e-3,
                    [&] { greatest = std::max(greatest, std::abs(length(run) - expected)); });
  const Real z2 = std::pow(reference(kDumbbell + "radial_omega") * 1e-3, 2);
  sheet.add("greatest deviation of the length [m]", expected * z2, greatest,
            at_most("second order: L z^2"), run);
  sheet.add("angular momentum after 1e4 steps [kg m^2/s]", reference(kDumbbell + "ang_mom"),
            run.diagnostics().bodies[0].angular_momentum.z(), within(1e-10, "round-off"), run);
  const Real tension = std::sqrt(2 * reference(kDumbbell + "k") * run.diagnostics().elastic_energy);
  sheet.add("tension [N]", reference(kDumbbell + "tension"), tension,
            within(reference(kDumbbell + "k") * expected * z2, "second order: k L z^2"), run);
  add_order_row(sheet, scene, IntegratorId::velocity_verlet, halved(1e-2, 3), 1, 2,
                [&](const Run& end) { return std::abs(length(end) - expected); });
}

/// Adds a small radial oscillation to the circle, with the same angular momentum.
void run_radial_swing(Sheet& sheet) {
  Scene scene = with_method(load_scene("DEF-6a"), IntegratorId::runge_kutta_4, 1e-3);
  auto& nodes = std::get<ParticleShape>(scene.bodies[0].shape).positions;
  const Real stretch = 1 + 1e-5;
  for (Vec3& place : nodes) place *= stretch;
  scene.bodies[0].angular_velocity /= stretch * stretch;
  Run run = sheet.start(scene);
  std::vector<Real> samples;
  run.observe_until(10, 1e-3, [&] { samples.push_back(length(run) - reference(kDumbbell + "L")); });
  sheet.add("radial frequency [rad/s]", reference(kDumbbell + "radial_omega"),
            fitted_frequency(samples, 1e-3),
            within_relative(1e-4, "amplitude 1e-5, fourth order: z^4"), run);
}

Real corner_error(const Run& run) {
  return (run.body().positions[7] - reference_vector(kCube + "corner_ppp/5")).norm();
}

struct Drift {
  Real momentum;          ///< [kg m/s]
  Real angular_momentum;  ///< [kg m^2/s]
  Real energy;            ///< relative
};

Drift drift(const Run& run, const BodyDiagnostics& start, Real start_energy) {
  const BodyDiagnostics now = run.diagnostics().bodies[0];
  return {(now.linear_momentum - start.linear_momentum).norm(),
          (now.angular_momentum - start.angular_momentum).norm(), run.energy() / start_energy - 1};
}

void add_cube_run(Sheet& sheet, const char* name, IntegratorId integrator, const char* step) {
  const std::string published =
      std::string("/measured_yardsticks/integrator_yardsticks/DEF-6b corner err t=5/") + name +
      '/' + step;
  const std::string method = std::string(to_string(integrator)) + ", step " + step;
  Run run = sheet.start(with_method(load_scene("DEF-6b"), integrator, std::stod(step)));
  const BodyDiagnostics start = run.diagnostics().bodies[0];
  const Real start_energy = run.energy();
  run.advance_to(5);
  sheet.add("error of a corner at t = 5 s [m], " + method, reference(published + "/0"),
            corner_error(run), within_relative(1e-3, "same method elsewhere (reference.json)"),
            run);
  const Drift drifted = drift(run, start, start_energy);
  sheet.add("momentum drift [kg m/s], " + method, 1e-12, drifted.momentum, at_most("round-off"),
            run);
  const bool symplectic =
      integrator == IntegratorId::symplectic_euler || integrator == IntegratorId::velocity_verlet;
  if (symplectic) {
    sheet.add("angular momentum drift [kg m^2/s], " + method, 1e-12, drifted.angular_momentum,
              at_most("round-off"), run);
  }
  const auto text = reference_at(published + "/1").get<std::string>();  // for example "dE 3.2e-03"
  sheet.add("energy drift, " + method, std::stod(text.substr(3)), drifted.energy,
            within_relative(0.05, "same method elsewhere, two digits"), run);
}

void run_cube(Sheet& sheet) {
  const Scene scene = load_scene("DEF-6b");
  const Run start = sheet.start(scene);
  const BodyDiagnostics body = start.diagnostics().bodies[0];
  sheet.add("energy at the start [J]", reference(kCube + "energy"), start.energy(),
            within_relative(1e-14, "round-off"), start);
  sheet.add("distance to the momentum at the start [kg m/s]", 1e-14,
            (body.linear_momentum - reference_vector(kCube + "momentum")).norm(),
            at_most("round-off"), start);
  sheet.add("distance to the angular momentum at the start [kg m^2/s]", 1e-14,
            (body.angular_momentum - reference_vector(kCube + "ang_mom_origin")).norm(),
            at_most("round-off"), start);
  const std::pair<const char*, IntegratorId> methods[] = {{"symp", IntegratorId::symplectic_euler},
                                                          {"verlet", IntegratorId::velocity_verlet},
                                                          {"heun", IntegratorId::heun},
                                                          {"rk4", IntegratorId::runge_kutta_4}};
  for (const auto& [name, integrator] : methods) {
    for (const char* step : {"0.01", "0.001"}) add_cube_run(sheet, name, integrator, step);
    // The springs start at rest length, so symplectic Euler follows the path of Verlet.
    const Real order = std::max<Real>(2, theoretical_order(integrator));
    add_order_row(sheet, scene, integrator, halved(5e-3, 3), 5, order, corner_error);
  }
}

}  // namespace

std::vector<Case> free_spin_cases() {
  const std::string kind = "deformable";
  return {
      {"DEF-6a",
       "two masses orbiting each other",
       kind,
       {"DEF-6a"},
       [](Sheet& sheet) {
         run_dumbbell(sheet);
         run_radial_swing(sheet);
       }},
      {"DEF-6b", "freely rotating cube of springs", kind, {"DEF-6b"}, run_cube},
  };
}

}  // namespace vat::validation
