#include <cmath>
#include <numbers>

#include "tests/validation/cases.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

Real of_reference(const char* name) {
  return reference(std::string("/rigid/RIG-7/") + name);
}

Real radians(Real degrees) {
  return degrees * std::numbers::pi / 180;
}

/// Returns the rate at which the slip decays [1/s]. It equals the frequency of the block on its
/// contact.
Real contact_rate(const Scene& scene) {
  return std::sqrt(scene.interfaces[0].constants.stiffness);
}

Real speed_of(const Run& run) {
  return run.body().velocities[0].x();
}

/// A block at rest on a slope. Its contact carries its weight.
Scene block_on_slope(Real angle) {
  Scene scene = load_scene("RIG-7");
  const Real g = of_reference("g");
  scene.gravity = {g * std::sin(angle), 0, -g * std::cos(angle)};
  scene.bodies[0].velocity.setZero();
  scene.bodies[0].position.z() = 0.05 - g * std::cos(angle) / std::pow(contact_rate(scene), 2);
  return scene;
}

void check_stop(Sheet& sheet) {
  const Scene scene = load_scene("RIG-7");
  const Real rate = contact_rate(scene);
  const Real deceleration = of_reference("mu") * of_reference("g");
  Run run = sheet.start(scene);
  const Real step = run.simulation().step_size();
  while (speed_of(run) > deceleration / rate) run.advance_to(run.simulation().time() + step);
  // Below mu g / rate, the speed decays as exp(-rate t) and not linearly.
  sheet.add("time until sticking [s]", of_reference("stop_time"), run.simulation().time(),
            within(1 / rate + step, "1 / sqrt(k/m) of the regularisation, and a step"), run);
  run.advance_to(1);
  sheet.add("stopping distance [m]", of_reference("stop_distance"), run.body().positions[0].x(),
            within(deceleration / (rate * rate), "mu g m / k of the regularisation"), run);
  sheet.add("speed at 1 s [m/s]", 0, speed_of(run), within(1e-12, "exp(-rate t), to round-off"),
            run);
}

/// Returns whether the block slips after a tenth of a second, which is long compared with 1 / rate.
bool slips(Sheet& sheet, Real degrees) {
  const Scene scene = block_on_slope(radians(degrees));
  Run run = sheet.start(scene);
  run.advance_to(0.1);
  const Real push = -scene.gravity.z();
  return speed_of(run) > of_reference("mu") * push / contact_rate(scene);
}

void check_slopes(Sheet& sheet) {
  constexpr Real kAccuracy = 1e-4;  // [degrees]
  Real low = 10;
  Real high = 30;
  while (high - low > kAccuracy) {
    const Real middle = (low + high) / 2;
    (slips(sheet, middle) ? high : low) = middle;
  }
  Run run = sheet.start(block_on_slope(radians(30)));
  sheet.add("greatest slope without sliding [degrees]", of_reference("incline_critical_deg"), low,
            within(2 * kAccuracy, "the bisection that finds it"), run);
  run.advance_to(0.5);
  const Real before = speed_of(run);
  run.advance_to(1);
  sheet.add("acceleration on a slope of 30 degrees [m/s^2]", of_reference("incline30_acc"),
            (speed_of(run) - before) / 0.5, within_relative(1e-9, "even, to round-off"), run);
}

/// A ball instead of the block.
Scene ball(Real angle, Real speed) {
  Scene scene = block_on_slope(angle);
  scene.bodies[0].kind = BodyKind::rigid;
  scene.bodies[0].velocity.x() = speed;
  return scene;
}

Real slip_of(const Run& run) {
  return speed_of(run) -
         run.body().pose->center_of_mass.z() * run.body().pose->angular_velocity.y();
}

void check_rolling(Sheet& sheet) {
  const Real v0 = of_reference("v0");
  const Tolerance arm = within_relative(1e-3, "overlap over radius, 2e-4, and how it is set up");
  Run run = sheet.start(ball(0, v0));
  run.advance_to(0.1);
  sheet.add("time until rolling, from the slip at 0.1 s [s]", of_reference("sphere_roll_time"),
            0.1 * v0 / (v0 - slip_of(run)), arm, run);
  run.advance_to(0.5);
  sheet.add("speed of rolling [m/s]", of_reference("sphere_roll_speed"), speed_of(run), arm, run);
  sheet.add("slip of rolling [m/s]", 0, slip_of(run), within(1e-9, "round-off"), run);
  Run down = sheet.start(ball(radians(20), 0));
  down.advance_to(0.25);
  const Real before = speed_of(down);
  down.advance_to(0.5);
  sheet.add("acceleration, rolling down 20 degrees [m/s^2]",
            of_reference("sphere_incline_roll_acc_20deg"), (speed_of(down) - before) / 0.25, arm,
            down);
}

void run_friction(Sheet& sheet) {
  check_stop(sheet);
  check_slopes(sheet);
  check_rolling(sheet);
}

}  // namespace

std::vector<Case> rigid_friction_cases() {
  return {{"RIG-7", "block and ball with friction", "rigid", {"RIG-7"}, run_friction}};
}

}  // namespace vat::validation
