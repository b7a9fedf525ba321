#include <algorithm>
#include <cmath>

#include "tests/support/totals.h"
#include "tests/validation/cases.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

// INT-6.

void run_impact(Sheet& sheet) {
  for (const char* stiffness : {"1000", "10000", "100000"}) {
    Scene scene = load_scene("INT-6");
    const Real k = std::stod(stiffness);
    scene.interfaces[0].constants.stiffness = k;
    Run run = sheet.start(scene);
    run.advance_to(0.2);
    const Diagnostics end = run.diagnostics();
    const Real first = end.bodies[0].linear_momentum.x();
    const Real center = end.bodies[1].linear_momentum.x() / 2;
    const Real energy =
        end.kinetic_energy + end.elastic_energy - first * first / 2 - center * center;
    const Real z = std::sqrt(2 * k) * scene.numerics.step;
    const Tolerance tolerance = within(z * z, "(omega dt)^2 of the approach at 1 m/s");
    const std::string at = std::string("/interaction/INT-6/kc=") + stiffness + '/';
    const std::string of = std::string(", k = ") + stiffness;
    sheet.add("ball afterwards [m/s]" + of, reference(at + "v1"), first, tolerance, run);
    sheet.add("dumbbell afterwards [m/s]" + of, reference(at + "vcm"), center, tolerance, run);
    sheet.add("energy of its vibration [J]" + of, reference(at + "vib_energy"), energy, tolerance,
              run);
    sheet.add("momentum [kg m/s]" + of, 1, first + 2 * center, within(1e-13, "round-off"), run);
  }
}

// INT-7.

/// The colliding bodies of the scene.
struct Pairing {
  const char* name;
  std::vector<std::size_t> bodies;
};

std::vector<Pairing> pairings() {
  return {{"liquid and liquid", {0, 5}},    {"liquid and deformable", {0, 1}},
          {"liquid and rigid", {0, 2}},     {"deformable and deformable", {1, 4}},
          {"deformable and rigid", {1, 2}}, {"rigid and rigid", {2, 3}},
          {"all three kinds", {0, 1, 2}}};
}

Scene scene_of(const Pairing& pairing, bool viscous) {
  Scene scene = load_scene("INT-7");
  std::vector<BodyDescription> bodies;
  for (const std::size_t b : pairing.bodies) bodies.push_back(scene.bodies[b]);
  scene.bodies = bodies;
  if (!viscous) scene.materials[0].liquid->viscosity = 0;
  return scene;
}

void check_pairing(Sheet& sheet, const Pairing& pairing, bool viscous) {
  const Real until = sheet.quick() ? 1 : 10;  // 1e4 steps
  Run run = sheet.start(scene_of(pairing, viscous));
  const Real scale = test::motion_of(run.simulation()).momentum;
  const Diagnostics start = run.diagnostics();
  const test::Totals before = test::totals_of(start);
  Real linear = 0;
  Real angular = 0;
  run.observe_until(until, until / 100, [&] {
    const test::Totals now = test::totals_of(run.diagnostics());
    linear = std::max(linear, (now.momentum - before.momentum).norm());
    angular = std::max(angular, (now.angular_momentum - before.angular_momentum).norm());
  });
  const std::string of = std::string(", ") + pairing.name + (viscous ? ", viscous" : "");
  const Real exchanged =
      (run.diagnostics().bodies[0].linear_momentum - start.bodies[0].linear_momentum).norm();
  sheet.add("momentum exchanged / sum m|v|" + of, 0.01, exchanged / scale,
            at_least("the bodies have met"), run);
  sheet.add("change of momentum / sum m|v|" + of, 0, linear / scale, within(1e-12, "round-off"),
            run);
  if (viscous)
    return;  // the viscous force of [MCG03] acts along v_ij, not x_ij, so it does not conserve spin
  sheet.add("change of angular momentum [kg m2/s]" + of, 0, angular,
            within(1e-10, "round-off of central forces"), run);
}

void run_pairings(Sheet& sheet) {
  for (const Pairing& pairing : pairings()) check_pairing(sheet, pairing, false);
  check_pairing(sheet, pairings().back(), true);
}

}  // namespace

std::vector<Case> interaction_impact_cases() {
  return {{"INT-6", "impact of a rigid ball on a dumbbell", "interaction", {"INT-6"}, run_impact},
          {"INT-7", "momentum of every pairing", "interaction", {"INT-7"}, run_pairings}};
}

}  // namespace vat::validation
