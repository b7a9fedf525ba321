#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/validation/cases.h"
#include "tests/validation/order.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

Scene heavy_top(const std::string& name, IntegratorId integrator, Real step) {
  Scene scene = load_scene(name);
  scene.numerics.integrator = integrator;
  scene.numerics.step = step;
  scene.numerics.tick = step;
  return scene;
}

Vec3 body_rate(const Run& run) {
  const RigidPose pose = *run.body().pose;
  return pose.orientation.conjugate() * pose.angular_velocity;
}

/// Returns the angle [rad] between the body and the attitude in the reference.
Real attitude_error(const Run& run, const std::string& pointer) {
  const Json& q = reference_at(pointer);
  const Quat exact(q.at(0).get<Real>(), q.at(1).get<Real>(), q.at(2).get<Real>(),
                   q.at(3).get<Real>());
  return run.body().pose->orientation.angularDistance(exact.normalized());
}

/// Returns the order of free rotation. The two kick-drift methods use a fourth-order composition
/// for it.
Real free_rotation_order(IntegratorId integrator) {
  const bool drifts =
      integrator == IntegratorId::symplectic_euler || integrator == IntegratorId::velocity_verlet;
  return drifts ? 4 : theoretical_order(integrator);
}

void check_orders(Sheet& sheet) {
  for (const IntegratorId integrator : kIntegrators) {
    const Real order = free_rotation_order(integrator);
    const Real longest = order < 2 ? 2e-3 : 8e-2;
    const std::vector<Real> steps{longest, longest / 2, longest / 4, longest / 8};
    std::vector<Real> errors;
    Row row{.metric = std::string("order of convergence of the attitude, ") + to_string(integrator),
            .reference = order,
            .tolerance = within(0.2, "order of the method")};
    for (const Real step : steps) {
      Run run = sheet.start(heavy_top("RIG-1", integrator, step));
      run.advance_to(10);
      errors.push_back(attitude_error(run, "/rigid/RIG-1/quat/10"));
      row.seconds += run.seconds();
      row.state_hash = run.state_hash();
    }
    row.measured = observed_order(steps, errors);
    sheet.add(row);
  }
}

void check_motion(Sheet& sheet) {
  Run run = sheet.start(heavy_top("RIG-1", IntegratorId::velocity_verlet, 0.01));
  sheet.add("energy at the start [J]", reference("/rigid/RIG-1/energy"), run.energy(),
            within_relative(1e-11, "the particles' own inertia"), run);
  const Real published =
      reference("/measured_yardsticks/rigid_torque_free_RIG1/rk4_on_q/2");  // at t = 10
  const std::pair<const char*, Real> times[] = {{"1", 1}, {"5", 5}, {"10", 10}, {"50", 50}};
  for (const auto& [name, time] : times) {
    run.advance_to(time);
    const std::string at = std::string("(") + name + ")";
    // Without a drift of the energy, the phase error grows at most linearly.
    const Tolerance tolerance = within(published * std::max(Real{1}, time / 10),
                                       "Runge-Kutta on the quaternion elsewhere (reference.json)");
    const Vec3 error = body_rate(run) - reference_vector("/rigid/RIG-1/w/" + std::string(name));
    sheet.add("error of omega" + at + " in body axes [rad/s], step 0.01", 0, error.norm(),
              tolerance, run);
    sheet.add("error of the attitude" + at + " [rad], step 0.01", 0,
              attitude_error(run, "/rigid/RIG-1/quat/" + std::string(name)), tolerance, run);
  }
}

void check_drift(Sheet& sheet) {
  const Real steps = sheet.quick() ? 1e4 : 1e6;
  Run run = sheet.start(heavy_top("RIG-1", IntegratorId::velocity_verlet, 0.02));
  const Vec3 momentum = run.diagnostics().bodies[0].angular_momentum;
  const Real energy = run.energy();
  Real worst = 0;
  run.observe_until(steps * 0.02, steps * 0.02 / 1000,
                    [&] { worst = std::max(worst, std::abs(run.energy() / energy - 1)); });
  sheet.add(sheet.quick() ? "greatest relative error of the energy in 1e4 steps of 0.02"
                          : "greatest relative error of the energy in 1e6 steps of 0.02",
            reference("/measured_yardsticks/rigid_torque_free_RIG1/rk4_on_q/4"), worst,
            at_most("Runge-Kutta on the quaternion elsewhere (reference.json)"), run);
  sheet.add("change of the angular momentum [kg m2/s]", 0,
            (run.diagnostics().bodies[0].angular_momentum - momentum).norm(),
            within(1e-12, "round-off of the steps taken"), run);
}

void run_asymmetric(Sheet& sheet) {
  check_motion(sheet);
  check_orders(sheet);
  check_drift(sheet);
}

/// Returns the first time [s] at which omega about the intermediate axis is zero, interpolated
/// linearly between steps.
Real first_zero(Run& run, Real step) {
  for (Real before = body_rate(run).y();;) {
    const Real begin = run.simulation().time();
    if (begin > 20) throw std::runtime_error("the heavy_top did not turn over in 20 s");
    run.advance_to(begin + step);
    const Real after = body_rate(run).y();
    if (after <= 0) return begin + step * before / (before - after);
    before = after;
  }
}

void run_middle_axis(Sheet& sheet) {
  const std::string source = "published target for order 2";
  for (const IntegratorId integrator :
       {IntegratorId::velocity_verlet, IntegratorId::heun, IntegratorId::runge_kutta_4}) {
    Run run = sheet.start(heavy_top("RIG-2", integrator, 0.01));
    const Real zero = first_zero(run, 0.01);
    sheet.add(std::string("time of the half turn [s], step 0.01, ") + to_string(integrator),
              reference("/rigid/RIG-2/first_zero_crossings_of_w2/0"), zero, within(1e-3, source),
              run);
  }
  Run run = sheet.start(heavy_top("RIG-2", IntegratorId::velocity_verlet, 0.01));
  for (const char* time : {"5", "10", "20", "40"}) {
    run.advance_to(std::stod(time));
    const Vec3 error = body_rate(run) - reference_vector(std::string("/rigid/RIG-2/w/") + time);
    sheet.add(std::string("error of omega(") + time + ") in body axes [rad/s], step 0.01", 0,
              error.norm(), within(1e-3, source), run);
  }
}

void run_symmetric(Sheet& sheet) {
  const Tolerance exact = within(1e-10, "exact for equal moments, to round-off");
  Run run = sheet.start(heavy_top("RIG-3", IntegratorId::velocity_verlet, 0.01));
  for (const char* time : {"1", "10"}) {
    run.advance_to(std::stod(time));
    const Vec3 error = body_rate(run) - reference_vector(std::string("/rigid/RIG-3a/w/") + time);
    const std::string at = std::string("(") + time + ")";
    sheet.add("error of omega" + at + " in body axes [rad/s], step 0.01", 0, error.norm(), exact,
              run);
    sheet.add("error of the attitude" + at + " [rad], step 0.01", 0,
              attitude_error(run, std::string("/rigid/RIG-3a/quat/") + time), exact, run);
  }
  sheet.add("angular momentum [kg m2/s]", reference("/rigid/RIG-3a/L"),
            run.diagnostics().bodies[0].angular_momentum.norm(),
            within_relative(1e-11, "the particles' own inertia"), run);
}

}  // namespace

std::vector<Case> rigid_top_cases() {
  return {{"RIG-1", "free asymmetric top", "rigid", {"RIG-1"}, run_asymmetric},
          {"RIG-2", "top about its intermediate axis", "rigid", {"RIG-2"}, run_middle_axis},
          {"RIG-3", "free symmetric top", "rigid", {"RIG-3"}, run_symmetric}};
}

}  // namespace vat::validation
