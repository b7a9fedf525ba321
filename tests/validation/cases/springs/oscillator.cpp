#include <cmath>
#include <stdexcept>
#include <utility>

#include "tests/validation/cases.h"
#include "tests/validation/convergence.h"
#include "tests/validation/order.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

const std::string kOscillator = "/deformable/DEF-1/";

Real position(const Run& run) {
  return run.body().positions[1].x();
}

/// Returns the distance [m] to the exact state at t = 1 s in the phase plane, in which the exact
/// path is a circle.
Real phase_plane_error(const Run& run) {
  const Real x = position(run) - reference(kOscillator + "x/1");
  const Real v = run.body().velocities[1].x() - reference(kOscillator + "v/1");
  return std::hypot(x, v / reference(kOscillator + "omega"));
}

/// Returns steps at which the leading term of the error dominates, and exceeds round-off.
std::vector<Real> steps_for(IntegratorId integrator) {
  const Real order = theoretical_order(integrator);
  return halved(order < 2 ? 1e-3 : order < 4 ? 1e-2 : 2e-2, 4);
}

void add_oscillator_published_errors(Sheet& sheet, const Scene& scene) {
  const std::string published = "/measured_yardsticks/integrator_yardsticks/DEF-1 |x-ref| t=10/";
  const std::pair<const char*, IntegratorId> methods[] = {{"symp", IntegratorId::symplectic_euler},
                                                          {"verlet", IntegratorId::velocity_verlet},
                                                          {"heun", IntegratorId::heun},
                                                          {"rk4", IntegratorId::runge_kutta_4}};
  for (const auto& [name, integrator] : methods) {
    for (const char* step : {"0.01", "0.001"}) {
      Run run = sheet.start(with_method(scene, integrator, std::stod(step)));
      run.advance_to(10);
      const Real error = std::abs(position(run) - reference(kOscillator + "x/10"));
      sheet.add(std::string("error of x(10) [m], ") + to_string(integrator) + ", step " + step,
                reference(published + name + '/' + step), error,
                within_relative(1e-3, "same method elsewhere (reference.json)"), run);
    }
  }
}

/// Adds x and v after 100 s. The phase error of a step is z^3/24 with z = omega dt. The next term
/// is at most a hundredth of it.
void add_long_run(Sheet& sheet, const Scene& scene) {
  Run run = sheet.start(with_method(scene, IntegratorId::velocity_verlet, 1e-3));
  sheet.add("energy at the start [J]", reference(kOscillator + "energy"), run.energy(),
            within_relative(1e-14, "round-off"), run);
  run.advance_to(100);
  const Real omega = reference(kOscillator + "omega");
  const Real amplitude = reference(kOscillator + "x0") - reference(kOscillator + "l");
  const Real bound = 1.01 * amplitude * omega * 100 * std::pow(omega * 1e-3, 2) / 24;
  sheet.add("x(100) [m], velocity_verlet, step 0.001", reference(kOscillator + "x/100"),
            position(run), within(bound, "phase error omega t z^2/24"), run);
  sheet.add("v(100) [m/s], velocity_verlet, step 0.001", reference(kOscillator + "v/100"),
            run.body().velocities[1].x(), within(omega * bound, "phase error omega t z^2/24"), run);
}

void run_undamped(Sheet& sheet) {
  const Scene scene = load_scene("DEF-1");
  for (const IntegratorId integrator : kIntegrators) {
    add_order_row(sheet, scene, integrator, steps_for(integrator), 1, theoretical_order(integrator),
                  phase_plane_error);
  }
  add_oscillator_published_errors(sheet, scene);
  add_long_run(sheet, scene);
}

void run_damped(Sheet& sheet) {
  const Scene scene = load_scene("DEF-1c");
  for (const IntegratorId integrator : kIntegrators) {
    add_order_row(sheet, scene, integrator, steps_for(integrator), 1, theoretical_order(integrator),
                  [](const Run& run) {
                    return std::abs(position(run) - reference("/deformable/DEF-1c/x/1"));
                  });
  }
  for (const char* time : {"0.1", "1", "2"}) {
    Run run = sheet.start(with_method(scene, IntegratorId::runge_kutta_4, 1e-3));
    run.advance_to(std::stod(time));
    sheet.add(std::string("x(") + time + ") [m], runge_kutta_4, step 0.001",
              reference(std::string("/deformable/DEF-1c/x/") + time), position(run),
              within(0.2 * 10 * std::stod(time) * std::pow(0.01, 4), "fourth order: A omega t z^4"),
              run);
  }
}

/// Returns the phase error of velocity Verlet, plus the half-step shift for symplectic Euler.
Real pair_bound(IntegratorId integrator, Real step, Real time) {
  const std::string pair = "/deformable/DEF-1b/";
  const Real omega = reference(pair + "omega");
  const Real amplitude = 0.75 * (reference(pair + "x2_0") - reference(pair + "l"));
  const Real z = omega * step;
  const Real phase = amplitude * omega * time * 1.01;
  switch (integrator) {
    case IntegratorId::explicit_euler:
      break;  // grows
    case IntegratorId::symplectic_euler:
      return amplitude * z + phase * z * z / 24;
    case IntegratorId::velocity_verlet:
      return phase * z * z / 24;
    case IntegratorId::heun:
      return phase * z * z / 6;
    case IntegratorId::runge_kutta_4:
      return phase * std::pow(z, 4) / 120;
  }
  throw std::invalid_argument("no bound for this integrator");
}

void run_pair(Sheet& sheet) {
  constexpr Real kStep = 1e-3;
  const Scene scene = load_scene("DEF-1b");
  for (const IntegratorId integrator : kIntegrators) {
    if (integrator == IntegratorId::explicit_euler) continue;  // its energy grows by e^13
    Run run = sheet.start(with_method(scene, integrator, kStep));
    run.advance_to(10);
    sheet.add(std::string("x1(10) [m], ") + to_string(integrator) + ", step 0.001",
              reference("/deformable/DEF-1b/x1/10"), run.body().positions[0].x(),
              within(pair_bound(integrator, kStep, 10), "error of the frequency"), run);
    const Vec3 momentum = run.diagnostics().bodies[0].linear_momentum;
    sheet.add(std::string("momentum drift [kg m/s], ") + to_string(integrator), 1e-12,
              momentum.norm(), at_most("round-off"), run);
  }
}

/// Compares the energy after 100 steps of z = 0.1 with the growth factor of the method.
void run_energy(Sheet& sheet) {
  constexpr Real kStep = 0.01;
  constexpr int kSteps = 100;
  const Real z2 = std::pow(reference(kOscillator + "omega") * kStep, 2);
  const Scene scene = load_scene("DEF-1");
  const std::pair<IntegratorId, Real> factors[] = {
      {IntegratorId::explicit_euler, 1 + z2},
      {IntegratorId::heun, 1 + z2 * z2 / 4},
      {IntegratorId::runge_kutta_4, 1 - std::pow(z2, 3) / 72 + std::pow(z2, 4) / 576}};
  for (const auto& [integrator, factor] : factors) {
    Run run = sheet.start(with_method(scene, integrator, kStep));
    const Real start = run.energy();
    run.advance_to(kSteps * kStep);
    sheet.add(std::string("growth of energy in a step, ") + to_string(integrator), factor - 1,
              std::pow(run.energy() / start, 1.0 / kSteps) - 1,
              within_relative(1e-4, "amplification factor at z = 0.1"), run);
  }
}

/// Adds the maximum and last deviation of the energy over many periods. They are bounded and have
/// no trend.
void add_bounded_energy(Sheet& sheet, IntegratorId integrator, Real bound, const char* source) {
  constexpr Real kStep = 0.01;
  const Real end = sheet.quick() ? 1e3 : 1e4;
  Run run = sheet.start(with_method(load_scene("DEF-1"), integrator, kStep));
  const Real start = run.energy();
  Real greatest = 0;
  run.observe_until(end, kStep,
                    [&] { greatest = std::max(greatest, std::abs(run.energy() / start - 1)); });
  sheet.add(std::string("greatest |E/E0 - 1|, ") + to_string(integrator) + ", z = 0.1", bound,
            greatest, at_most(source), run);
}

void run_energy_case(Sheet& sheet) {
  run_energy(sheet);
  const Real z = reference(kOscillator + "omega") * 0.01;
  // The modified energies v^2 + (1 - z^2/4) omega^2 x^2 and E -+ z/2 omega x v are exactly
  // conserved.
  constexpr Real kRoundOff = 1 + 1e-9;
  add_bounded_energy(sheet, IntegratorId::velocity_verlet, z * z / 4 * kRoundOff,
                     "modified energy: z^2/4");
  add_bounded_energy(sheet, IntegratorId::symplectic_euler, z / (2 - z) * kRoundOff,
                     "modified energy: z/(2 - z)");
}

}  // namespace

std::vector<Case> oscillator_cases() {
  const std::string kind = "deformable";
  return {
      {"DEF-1", "undamped mass on a spring", kind, {"DEF-1"}, run_undamped},
      {"DEF-1b", "two free masses and a spring", kind, {"DEF-1b"}, run_pair},
      {"DEF-1c", "damped mass on a spring", kind, {"DEF-1c"}, run_damped},
      {"DEF-1d", "energy drift of the integrators", kind, {"DEF-1"}, run_energy_case},
  };
}

}  // namespace vat::validation
