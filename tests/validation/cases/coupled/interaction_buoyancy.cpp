#include <cmath>
#include <numbers>

#include "tests/validation/cases.h"
#include "tests/validation/cases/liquid/liquid_rest.h"
#include "tests/validation/cases/liquid/pool.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

constexpr Real kDepth = 0.8;           // of the pool, and its width [m]
constexpr Real kBuoyancyRadius = 0.2;  // of the ball: four spacings [m]
constexpr Real kVolume =
    4 * std::numbers::pi / 3 * kBuoyancyRadius * kBuoyancyRadius * kBuoyancyRadius;
constexpr const char* kInterface =
    "the threshold of the spring interface sets the force instead of the displaced liquid";

/// A scene with `threshold` spacings between liquid and ball, the ball's centre at `height`, and no
/// liquid in the ball.
Scene pool_with_ball(Real threshold, Real density_ratio, Real height = 0.4) {
  Scene scene = load_scene("INT-5");
  scene.bodies[1].position.z() = height;
  set_rest_mass(scene);
  const Real spacing = scene.bodies[0].spacing;
  clear_around_ball(scene, kBuoyancyRadius + spacing / 4);
  scene.interfaces[1].threshold = threshold * spacing;
  scene.materials[1].density = 1000 * density_ratio;
  return with_step(scene, acoustic_step(scene, 0.02));
}

std::string buoyancy_text(Real value) {
  std::string digits = std::to_string(value);
  return digits.substr(0, digits.find('.') + 3);
}

// INT-5, INT-8.

void check_held(Sheet& sheet, Real threshold) {
  Run run = sheet.start(pool_with_ball(threshold, 1));
  const Real until = sheet.quick() ? 2 : 3;
  run.advance_to(1);
  Real on_ball = 0;
  Real on_liquid = 0;
  int samples = 0;
  run.observe_until(until, run.simulation().step_size(), [&] {
    const Diagnostics now = run.diagnostics();
    on_liquid += now.bodies[0].outer_force.z();
    on_ball += now.bodies[1].outer_force.z();
    ++samples;
  });
  const std::string of = ", threshold " + buoyancy_text(threshold) + " dx";
  sheet.add("buoyant force / (rho g V)" + of, 1, on_ball / samples / (1000 * kGravity * kVolume),
            reported(kInterface), run);
  const Real weight = run.diagnostics().bodies[0].mass * kGravity;
  sheet.add("force of walls and ball on the liquid / its weight" + of, 1,
            on_liquid / samples / weight,
            within(0.05 * std::sqrt(kDepth / kGravity) / (until - 1),
                   "momentum of a liquid at the published residual speed"),
            run);
}

void run_held(Sheet& sheet) {
  for (const Real threshold : {1.0, 1.5}) check_held(sheet, threshold);
}

// INT-1.

void check_floating(Sheet& sheet, const char* ratio, Real threshold) {
  const Real exact =
      reference(std::string("/interaction/INT-1/sphere_draft_over_diameter/") + ratio);
  // The ball starts at its equilibrium, since it rises slowly between the walls.
  Scene scene =
      pool_with_ball(threshold, std::stod(ratio), kDepth + kBuoyancyRadius * (1 - 2 * exact));
  scene.bodies[1].fixed = false;
  Run run = sheet.start(scene);
  run.advance_to(2);
  Real sum = 0;
  int samples = 0;
  run.observe_until(3, 0.02, [&] {
    sum += draft(run, kBuoyancyRadius, kDepth * kDepth);
    ++samples;
  });
  sheet.add(
      std::string("draft / diameter, density ratio ") + ratio + ", threshold " +
          buoyancy_text(threshold) + " dx",
      exact, sum / samples,
      reported(std::string(kInterface) + "; the liquid is denser at walls, and its level is lower"),
      run);
}

void run_floating(Sheet& sheet) {
  if (sheet.quick()) return check_floating(sheet, "0.5", 1.25);
  for (const char* ratio : {"0.25", "0.5", "0.75"}) {
    for (const Real threshold : {1.0, 1.25, 1.5}) check_floating(sheet, ratio, threshold);
  }
}

// INT-3.

void check_release(Sheet& sheet, const char* ratio) {
  Scene scene = pool_with_ball(1.25, std::stod(ratio));
  scene.bodies[1].fixed = false;
  scene.bodies[1].release = 1.5;
  Run run = sheet.start(scene);
  const Vec3 held_at = run.body("ball").pose->center_of_mass;
  run.advance_to(1.5);
  sheet.add(std::string("distance moved while held [m], density ratio ") + ratio, 0,
            (run.body("ball").pose->center_of_mass - held_at).norm(), within(0, "held"), run);
  constexpr Real kWhile = 0.04;  // two periods of the ball on the interface springs
  run.advance_to(1.5 + kWhile);
  const std::string at = std::string("/interaction/INT-3/sphere/") + ratio + '/';
  sheet.add(std::string("acceleration downwards after release [m/s2], density ratio ") + ratio,
            reference(at + "infinite"), -run.body("ball").pose->velocity.z() / kWhile,
            reported(kInterface), run);
}

void run_release(Sheet& sheet) {
  for (const char* ratio : {"0.5", "2", "4"}) {
    if (sheet.quick() && ratio != std::string("2")) continue;
    check_release(sheet, ratio);
  }
}

}  // namespace

std::vector<Case> interaction_buoyancy_cases() {
  return {{"INT-1", "floating ball", "interaction", {"INT-5"}, run_floating},
          {"INT-3", "ball released in a liquid", "interaction", {"INT-5"}, run_release},
          {"INT-5", "buoyancy of a held ball", "interaction", {"INT-5"}, run_held}};
}

}  // namespace vat::validation
