#include <cmath>
#include <complex>

#include "tests/validation/cases.h"
#include "tests/validation/order.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

Scene oscillator(IntegratorId integrator, Real step) {
  Scene scene = load_scene("spring-oscillator");
  scene.numerics.integrator = integrator;
  scene.numerics.step = step;
  scene.numerics.tick = step;
  return scene;
}

Real position(const Run& run) {
  return run.body().positions[1].x();
}

/// Distance to the reference state in the phase plane, in which an exact run is a circle [m].
Real phase_plane_error(const Run& run, const std::string& time) {
  const Real omega = reference("/deformable/DEF-1/omega");
  const Real x = position(run) - reference("/deformable/DEF-1/x/" + time);
  const Real v = run.body().velocities[1].x() - reference("/deformable/DEF-1/v/" + time);
  return std::hypot(x, v / omega);
}

/// Four steps that are short enough for the leading term of the error and long enough for it to
/// stand above round-off.
std::vector<Real> steps_for(IntegratorId integrator) {
  const Real order = theoretical_order(integrator);
  const Real longest = order < 2 ? 1e-3 : order < 4 ? 1e-2 : 2e-2;
  return {longest, longest / 2, longest / 4, longest / 8};
}

void check_orders(Sheet& sheet) {
  for (const IntegratorId integrator : kIntegrators) {
    const std::vector<Real> steps = steps_for(integrator);
    std::vector<Real> errors;
    Row row{.metric = std::string("order of convergence, ") + to_string(integrator),
            .reference = theoretical_order(integrator),
            .tolerance = within(0.2, "order of the method")};
    for (const Real step : steps) {
      Run run = sheet.start(oscillator(integrator, step));
      run.advance_to(1);
      errors.push_back(phase_plane_error(run, "1"));
      row.seconds += run.seconds();
      row.state_hash = run.state_hash();
    }
    row.measured = observed_order(steps, errors);
    sheet.add(row);
  }
}

void check_published_errors(Sheet& sheet) {
  const std::string published = "/measured_yardsticks/integrator_yardsticks/DEF-1 |x-ref| t=10/";
  const std::pair<const char*, IntegratorId> methods[] = {{"symp", IntegratorId::symplectic_euler},
                                                          {"verlet", IntegratorId::velocity_verlet},
                                                          {"heun", IntegratorId::heun},
                                                          {"rk4", IntegratorId::runge_kutta_4}};
  for (const auto& [name, integrator] : methods) {
    for (const char* step : {"0.01", "0.001"}) {
      Run run = sheet.start(oscillator(integrator, std::stod(step)));
      run.advance_to(10);
      const Real error = std::abs(position(run) - reference("/deformable/DEF-1/x/10"));
      sheet.add(std::string("error of x(10) [m], ") + to_string(integrator) + ", step " + step,
                reference(published + name + '/' + step), error,
                within_relative(1e-3, "same method elsewhere (reference.json)"), run);
    }
  }
}

void run_undamped(Sheet& sheet) {
  check_orders(sheet);
  check_published_errors(sheet);
  Run run = sheet.start(oscillator(IntegratorId::velocity_verlet, 1e-3));
  sheet.add("energy at the start [J]", reference("/deformable/DEF-1/energy"), run.energy(),
            within_relative(1e-14, "round-off"), run);
}

}  // namespace

std::vector<Case> oscillator_cases() {
  return {
      {"DEF-1", "undamped mass on a spring", "deformable", {"spring-oscillator"}, run_undamped}};
}

}  // namespace vat::validation
