#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/validation/cases.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

/// Far beyond 2 / omega of the springs of RIG-4 to RIG-7, which is 20 ms to 2 ms.
constexpr Real kFrame = 1.0 / 60;

InterfaceConstants projection(Real friction, Real restitution) {
  return {.friction = friction, .law = InterfaceLaw::projection, .restitution = restitution};
}

/// Loads a validation scene and replaces its contact springs by projections.
Scene load_hard(const char* name, Real step, Real friction, Real restitution) {
  Scene scene = with_step(load_scene(name), step);
  scene.default_interface = projection(friction, restitution);
  for (InterfaceDescription& interface : scene.interfaces) {
    interface.constants = projection(friction, restitution);
  }
  return scene;
}

RigidPose pose_of(const Run& run) {
  return *run.body().pose;
}

Real steps_until(Real time, Real step) {
  return step * std::ceil(time / step - 1e-6);
}

// RIG-4 and RIG-5.

void check_projected_restitution(Sheet& sheet) {
  for (const Real e : {1.0, 0.5, 0.0}) {
    Scene scene = load_hard("RIG-4", kFrame, 0, e);
    scene.gravity.setZero();
    scene.bodies[0].position.z() = 0.3;
    scene.bodies[0].velocity.z() = -2;
    Run run = sheet.start(scene);
    run.advance_to(12 * kFrame);
    sheet.add("restitution " + std::to_string(e).substr(0, 3), e, pose_of(run).velocity.z() / 2,
              within(1e-12, "round-off"), run);
  }
}

void check_collisions(Sheet& sheet) {
  for (const char* name : {"RIG-5a", "RIG-5b", "RIG-5c"}) {
    const std::string at = std::string("/rigid/") + name + "/";
    Scene scene = load_hard("RIG-5", 5e-3, 0, 1);
    std::array<Real, 2> masses{};
    for (std::size_t b = 0; b < 2; ++b) {
      const std::string index = std::to_string(b);
      masses[b] = reference(at + "m/" + index);
      std::get<ParticleShape>(scene.bodies[b].shape).masses = {masses[b]};
      scene.bodies[b].velocity.x() = reference(at + "v/" + index);
    }
    Run run = sheet.start(scene);
    run.advance_to(0.05);
    const std::string of = ", " + std::to_string(std::lround(masses[0])) + " kg on " +
                           std::to_string(std::lround(masses[1])) + " kg";
    Real momentum = 0;
    for (std::size_t b = 0; b < 2; ++b) {
      const Real speed = run.simulation().bodies()[b].pose->velocity.x();
      momentum += masses[b] * speed;
      sheet.add(std::string(b == 0 ? "first" : "second") + " ball afterwards [m/s]" + of,
                reference(at + "v_out/" + std::to_string(b)), speed, within(1e-11, "round-off"),
                run);
    }
    sheet.add("momentum [kg m/s]" + of, reference(at + "momentum"), momentum,
              within(1e-13 * 2 * masses[0], "round-off"), run);
  }
}

// RIG-6.

constexpr int kProjectedStack = 5;

std::array<Real, kProjectedStack> heights(const Run& run) {
  std::array<Real, kProjectedStack> result{};
  for (std::size_t i = 0; i < kProjectedStack; ++i) {
    result[i] = run.simulation().bodies()[i].pose->center_of_mass.z();
  }
  return result;
}

void check_stack(Sheet& sheet) {
  Run run = sheet.start(load_hard("RIG-6", kFrame, 0, 0));
  run.advance_to(5);
  const std::array<Real, kProjectedStack> settled = heights(run);
  run.advance_to(sheet.quick() ? 10 : 65);
  const std::array<Real, kProjectedStack> last = heights(run);
  Real deepest = 0;
  Real creep = 0;
  for (std::size_t i = 0; i < kProjectedStack; ++i) {
    deepest = std::max(deepest, std::abs(last[i] - (0.05 + 0.1 * static_cast<Real>(i))));
    creep = std::max(creep, std::abs(last[i] - settled[i]));
  }
  sheet.add("stack of 5, greatest error of a height [m]", 0, deepest,
            within(1e-6, "1e-5 of a ball's diameter"), run);
  sheet.add("stack of 5, creep from 5 s on [m]", 0, creep, within(1e-6, "published target"), run);
  sheet.add("stack of 5, kinetic energy / (m g 0.1 mm)", 1e-6,
            run.diagnostics().kinetic_energy / (2 * 9.81 * 1e-4), at_most("published target"), run);
}

// RIG-7.

Real projected_of_reference(const char* name) {
  return reference(std::string("/rigid/RIG-7/") + name);
}

Real projected_radians(Real degrees) {
  return degrees * std::numbers::pi / 180;
}

/// The ball of RIG-7 on a slope, 0.05 m above it.
Scene ball_on_slope(Real angle, Real step, Real friction) {
  Scene scene = load_hard("RIG-7", step, friction, 0);
  const Real g = projected_of_reference("g");
  scene.gravity = {g * std::sin(angle), 0, -g * std::cos(angle)};
  scene.bodies[0].kind = BodyKind::rigid;
  scene.bodies[0].velocity.setZero();
  scene.bodies[0].position.z() = 0.05;
  return scene;
}

/// The same for a block of 4 by 4 by 2 balls.
Scene projected_block_on_slope(Real angle, Real step, Real friction) {
  Scene scene = ball_on_slope(angle, step, friction);
  ParticleShape block;
  for (int i = 0; i < 32; ++i) {
    block.positions.push_back(
        0.1 * Vec3(static_cast<Real>(i % 4) - 1.5, static_cast<Real>(i / 4 % 4) - 1.5, i / 16));
  }
  block.masses.assign(32, 1.0 / 32);
  scene.bodies[0].shape = block;
  return scene;
}

void check_projected_stop(Sheet& sheet) {
  Scene scene = projected_block_on_slope(0, kFrame, projected_of_reference("mu"));
  scene.bodies[0].velocity.x() = projected_of_reference("v0");
  Run run = sheet.start(scene);
  const Real start = pose_of(run).center_of_mass.x();
  run.advance_to(2);
  const Real deceleration = projected_of_reference("mu") * projected_of_reference("g");
  sheet.add("stopping distance of a block [m]", projected_of_reference("stop_distance"),
            pose_of(run).center_of_mass.x() - start,
            within(deceleration * kFrame * kFrame, "mu g dt^2: it stops within a step"), run);
  sheet.add("speed at 2 s [m/s]", 0, pose_of(run).velocity.norm(), within(1e-6, "the solve"), run);
}

bool projected_slips(Sheet& sheet, Real degrees) {
  Run run = sheet.start(
      projected_block_on_slope(projected_radians(degrees), kFrame, projected_of_reference("mu")));
  run.advance_to(steps_until(1, kFrame));
  return pose_of(run).velocity.x() > 1e-4;
}

void check_slope(Sheet& sheet) {
  constexpr Real kAccuracy = 1e-2;  // [degrees]
  Real low = 10;
  Real high = 30;
  while (high - low > kAccuracy) {
    const Real middle = (low + high) / 2;
    (projected_slips(sheet, middle) ? high : low) = middle;
  }
  Run run = sheet.start(
      projected_block_on_slope(projected_radians(30), kFrame, projected_of_reference("mu")));
  sheet.add("greatest slope without sliding of a block [degrees]",
            projected_of_reference("incline_critical_deg"), low,
            within(2 * kAccuracy, "the bisection that finds it"), run);
  run.advance_to(0.5);
  const Real before = pose_of(run).velocity.x();
  run.advance_to(1);
  sheet.add("acceleration on a slope of 30 degrees [m/s^2]",
            projected_of_reference("incline30_acc"), (pose_of(run).velocity.x() - before) / 0.5,
            within_relative(1e-5, "the solve"), run);
  Run holds = sheet.start(
      projected_block_on_slope(projected_radians(15), kFrame, projected_of_reference("mu")));
  holds.advance_to(1);
  const Vec3 settled = pose_of(holds).center_of_mass;
  holds.advance_to(sheet.quick() ? 5 : 61);
  sheet.add("creep of a block on 15 degrees from 1 s on [m]", 0,
            (pose_of(holds).center_of_mass - settled).norm(), within(1e-6, "published target"),
            holds);
}

void check_projected_rolling(Sheet& sheet) {
  Scene scene = ball_on_slope(0, 1e-3, projected_of_reference("mu"));
  scene.bodies[0].velocity.x() = projected_of_reference("v0");
  Run run = sheet.start(scene);
  const auto slip = [&] {
    const RigidPose pose = pose_of(run);
    return pose.velocity.x() - 0.05 * pose.angular_velocity.y();
  };
  while (slip() > 1e-6) run.advance_to(run.simulation().time() + 1e-3);
  sheet.add("time until rolling of a ball [s]", projected_of_reference("sphere_roll_time"),
            run.simulation().time(), within(1e-3, "one step"), run);
  sheet.add("distance until rolling [m]", projected_of_reference("sphere_roll_distance"),
            pose_of(run).center_of_mass.x(), within(2e-3, "one step at 2 m/s"), run);
  run.advance_to(0.5);
  sheet.add("speed of rolling [m/s]", projected_of_reference("sphere_roll_speed"),
            pose_of(run).velocity.x(), within(1e-6, "the solve"), run);
  Run down =
      sheet.start(ball_on_slope(projected_radians(20), kFrame, projected_of_reference("mu")));
  down.advance_to(0.5);
  sheet.add("acceleration, rolling down 20 degrees [m/s^2]",
            projected_of_reference("sphere_incline_roll_acc_20deg"),
            pose_of(down).velocity.x() / 0.5, within_relative(1e-6, "the solve"), down);
}

// RIG-8.

void check_eccentric(Sheet& sheet) {
  const Scene scene = load_hard("RIG-8", 1e-4, 0, 1);
  Run run = sheet.start(scene);
  run.advance_to(0.15);
  const Real omega = reference("/rigid/RIG-8_dumbbell/omega_out");
  // The body turns within the step of the bounce, and its ends are balls of 1 mm.
  const Tolerance tolerance = within(1e-4 * std::abs(omega), "omega dt");
  sheet.add("dumbbell's centre afterwards [m/s]", reference("/rigid/RIG-8_dumbbell/v_cm_out"),
            pose_of(run).velocity.z(), tolerance, run);
  sheet.add("its angular velocity afterwards [rad/s]", std::abs(omega),
            pose_of(run).angular_velocity.norm(), tolerance, run);
}

void run_projection(Sheet& sheet) {
  check_projected_restitution(sheet);
  check_collisions(sheet);
  check_stack(sheet);
  check_projected_stop(sheet);
  check_slope(sheet);
  check_projected_rolling(sheet);
  check_eccentric(sheet);
}

}  // namespace

std::vector<Case> rigid_projection_cases() {
  return {{"RIG-9",
           "contacts by projection with long steps",
           "rigid",
           {"RIG-4", "RIG-5", "RIG-6", "RIG-7", "RIG-8"},
           run_projection}};
}

}  // namespace vat::validation
