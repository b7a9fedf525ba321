#include <cmath>
#include <utility>

#include "tests/validation/cases.h"
#include "tests/validation/convergence.h"
#include "tests/validation/order.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

Real error_at_five_seconds(const Run& run, const std::string& stiffness) {
  const std::string state = "/deformable/DEF-4b_k" + stiffness + "/state/5/";
  const Vec3 place = run.body().positions[1];
  return std::hypot(place.x() - reference(state + "0"), place.y() - reference(state + "1"));
}

void add_pendulum_published_errors(Sheet& sheet, const Scene& scene) {
  const std::string published =
      "/measured_yardsticks/integrator_yardsticks/DEF-4b k=1e4 |x-ref| t=5/";
  const std::pair<const char*, IntegratorId> methods[] = {{"symp", IntegratorId::symplectic_euler},
                                                          {"verlet", IntegratorId::velocity_verlet},
                                                          {"heun", IntegratorId::heun},
                                                          {"rk4", IntegratorId::runge_kutta_4}};
  for (const auto& [name, integrator] : methods) {
    for (const char* step : {"0.002", "0.001"}) {
      Run run = sheet.start(with_method(scene, integrator, std::stod(step)));
      run.advance_to(5);
      sheet.add(std::string("error at t = 5 s [m], ") + to_string(integrator) + ", step " + step,
                reference(published + name + '/' + step), error_at_five_seconds(run, "10000"),
                within_relative(1e-3, "same method elsewhere (reference.json)"), run);
    }
    add_order_row(sheet, scene, integrator, halved(1e-3, 3), 5, theoretical_order(integrator),
                  [](const Run& run) { return error_at_five_seconds(run, "10000"); });
  }
}

/// Adds the path with Runge-Kutta. Its error at t = 5 s is below omega t z^4/120 of the vibration's
/// amplitude, which is the extension at the bottom, 3 m g / k.
void add_path(Sheet& sheet, Scene scene, const std::string& stiffness) {
  constexpr Real kStep = 1e-3;
  scene.bodies[0].springs[0].constants.stiffness = std::stod(stiffness);
  Run run = sheet.start(with_method(std::move(scene), IntegratorId::runge_kutta_4, kStep));
  run.advance_to(5);
  const Real omega = std::sqrt(std::stod(stiffness));
  const Real bound = omega * 5 * std::pow(omega * kStep, 4) / 120 * 3 * 9.81 / (omega * omega);
  sheet.add("distance to the path at t = 5 s [m], k = " + stiffness, bound,
            error_at_five_seconds(run, stiffness), at_most("A omega t z^4/120"), run);
}

void run_pendulum(Sheet& sheet) {
  const Scene scene = load_scene("DEF-4");
  add_pendulum_published_errors(sheet, scene);
  for (const char* stiffness : {"1000", "10000", "100000"}) add_path(sheet, scene, stiffness);
}

}  // namespace

std::vector<Case> pendulum_cases() {
  return {{"DEF-4", "pendulum on a spring", "deformable", {"DEF-4"}, run_pendulum}};
}

}  // namespace vat::validation
