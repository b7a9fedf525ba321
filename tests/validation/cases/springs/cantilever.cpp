#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/validation/cases.h"
#include "tests/validation/order.h"
#include "tests/validation/reference.h"
#include "tests/validation/relax.h"

namespace vat::validation {

namespace {

const std::string kBeam = "/deformable/DEF-5/";
constexpr std::size_t kTip = 10 * 9 + 1 * 3 + 1;  // node (10, 1, 1)

const std::vector<Vec3>& cantilever_nodes(const Scene& scene) {
  return std::get<ParticleShape>(scene.bodies[0].shape).positions;
}

Equilibrium add_static_rows(Sheet& sheet) {
  Equilibrium rest = relax(load_scene("DEF-5"), 1e-9, sheet);
  const Vec3 expected = reference_vector(kBeam + "tip_centre");
  for (const int axis : {0, 2}) {
    Row row = rest.origin;
    row.metric = std::string("static tip ") + (axis == 0 ? "x" : "z") + " [m]";
    row.reference = expected[axis];
    row.measured = cantilever_nodes(rest.scene)[kTip][axis];
    row.tolerance = within_relative(1e-6, "equilibrium to a force of 1e-9 N");
    sheet.add(std::move(row));
  }
  return rest;
}

/// Adds the frequency of small oscillations of a beam in equilibrium along one axis. The initial
/// velocities grow with the square of the distance, so the start excites mainly the lowest mode.
void add_frequency(Sheet& sheet, Scene scene, int axis, const std::string& metric, Real expected) {
  constexpr Real kStep = 1e-3;
  auto& beam = std::get<ParticleShape>(scene.bodies[0].shape);
  const std::vector<Vec3> rest = beam.positions;
  for (const Vec3& place : rest) {
    beam.velocities.emplace_back(1e-4 * place.x() * place.x() * Vec3::Unit(axis));
  }
  Run run = sheet.start(with_step(std::move(scene), kStep));
  std::vector<Real> samples;
  run.observe_until(sheet.quick() ? 5 : 20, kStep, [&] {
    Real sum = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      sum += (run.body().positions[i] - rest[i])[axis] * rest[i].x() * rest[i].x();
    }
    samples.push_back(sum);
  });
  const Real z2 = std::pow(expected * kStep, 2);
  sheet.add(metric, expected, spectral_frequency(samples, kStep, expected),
            within_relative(z2 / 24 + 1e-5, "z^2/24 of Verlet, fit 1e-5"), run);
}

/// Compares errors of the tip's height after 0.5 and 1 s with published errors of the same methods,
/// given to three digits.
void add_published_errors(Sheet& sheet) {
  const Scene scene = load_scene("DEF-5");
  const std::pair<const char*, IntegratorId> methods[] = {
      {"symplectic_euler", IntegratorId::symplectic_euler},
      {"verlet", IntegratorId::velocity_verlet},
      {"heun", IntegratorId::heun},
      {"rk4", IntegratorId::runge_kutta_4}};
  const Real half = reference(kBeam + "dynamic_release/tip_z/0.5");
  const Real whole = reference(kBeam + "dynamic_release/tip_z/1.0");
  for (const auto& [name, integrator] : methods) {
    for (const Json& published :
         reference_at(std::string("/measured_yardsticks/cantilever_dynamic_DEF5/") + name)) {
      if (published.at(1).is_null()) continue;  // unstable there too
      const Real step = published.at(0).get<Real>();
      if (std::abs(0.5 / step - std::round(0.5 / step)) > 1e-6) continue;
      Run run = sheet.start(with_method(scene, integrator, step));
      const std::string method =
          std::string(to_string(integrator)) + ", step " + published.at(0).dump();
      run.advance_to(0.5);
      sheet.add("error of tip z(0.5) [m], " + method, 1.02 * published.at(1).get<Real>(),
                std::abs(run.body().positions[kTip].z() - half),
                at_most("same method elsewhere, 2 % for its digits"), run);
      run.advance_to(1);
      sheet.add("error of tip z(1) [m], " + method, 1.02 * published.at(2).get<Real>(),
                std::abs(run.body().positions[kTip].z() - whole),
                at_most("same method elsewhere, 2 % for its digits"), run);
    }
  }
}

void run_beam(Sheet& sheet) {
  Scene loaded = add_static_rows(sheet).scene;
  add_frequency(sheet, loaded, 1, "lowest frequency across gravity [rad/s]",
                reference(kBeam + "omega_lowest/0"));
  add_frequency(sheet, loaded, 2, "lowest frequency along gravity [rad/s]",
                reference(kBeam + "omega_lowest/1"));
  Scene unloaded = load_scene("DEF-5");
  unloaded.gravity = Vec3::Zero();
  add_frequency(sheet, unloaded, 2, "lowest frequency without gravity [rad/s]",
                reference(kBeam + "omega_lowest_unloaded/0"));
  add_published_errors(sheet);
}

}  // namespace

std::vector<Case> cantilever_cases() {
  return {{"DEF-5", "beam of springs, clamped at one end", "deformable", {"DEF-5"}, run_beam}};
}

}  // namespace vat::validation
