#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/stability/adversarial/cases.h"
#include "tests/stability/builders.h"

namespace vat::stability {
namespace {

constexpr Real kRadius = kSpacing / 2;

/// A wall of stiffness k stops a particle up to the speed r sqrt(k / m). Slower particles turn back
/// before their centres reach the wall.
void add_shots_at_walls(Cases& cases) {
  constexpr Real kMass = 0.1;
  for (const BodyKind kind : kKinds) {
    for (const Real stiffness : {1e4, 1e6}) {
      for (const Real part : {0.2, 0.5, 0.9, 1.5, 10.0}) {
        const Real speed = part * kRadius * std::sqrt(stiffness / kMass);
        Scene scene = make_tank();
        for (auto& interface : scene.interfaces) interface.constants = {stiffness, 0};
        scene.bodies = {make_particle("shot", kind, {0.5, 0.5, 0.5}, kMass)};
        scene.bodies[0].velocity = speed * Vec3(1, 0.3, 0.2).normalized();
        take_stable_step(scene, 0.3);
        cases.push_back({.group = std::string("shot at a wall: ") + to_string(kind),
                         .name = std::string(to_string(kind)) + " shot at a wall of " +
                                 label(stiffness) + " N/m with " + label(part) +
                                 " of the speed it bears",
                         .scene = scene,
                         .expected = part < 1 ? Expected::runs : Expected::may_stop});
      }
    }
  }
}

/// Projectiles that are several times too fast for the step, so the guard must divide it.
void add_shots_in_long_steps(Cases& cases) {
  for (const Real travel : {1.5, 3.0, 6.0, 20.0}) {  // radii per step
    Scene scene = make_tank();
    constexpr Real kStep = 1e-3;
    const Real speed = travel * kRadius / kStep;
    for (auto& interface : scene.interfaces) {
      interface.constants = {0.1 * std::pow(speed / (0.5 * kRadius), 2), 0};
    }
    scene.bodies = {make_particle("shot", BodyKind::rigid, {0.5, 0.5, 0.5}, 0.1)};
    scene.bodies[0].velocity = {speed, 0, 0};
    cases.push_back({.group = "shot in long steps",
                     .name = "shot of " + label(travel) + " radii in a step",
                     .scene = scene,
                     .expected = Expected::may_stop,
                     .duration = 0.1});
  }
}

/// A plate one particle thick. The projectile hits a particle, or the gap between four particles.
Scene make_plate(bool between, Real part, BodyKind kind) {
  constexpr Real kStiffness = 1e5;
  constexpr Real kShot = 0.1;
  constexpr Real kPlate = 50;
  Scene scene = make_scene();
  scene.gravity = Vec3::Zero();
  scene.default_interface = {kStiffness, 0};
  const std::vector<Vec3> points = test::make_lattice(1, 7, 7, kSpacing);
  const Vec3 aim = between ? Vec3(0, kRadius, kRadius) : Vec3::Zero();
  Real barrier = 0;
  for (const Vec3& point : points) {
    barrier += 0.5 * kStiffness * std::pow(std::max(0.0, kSpacing - (point - aim).norm()), 2);
  }
  const Real reduced_mass = kShot * kPlate / (kShot + kPlate);
  scene.bodies = {test::make_body("plate", BodyKind::rigid, "wood",
                                  test::make_particles(points, kPlate / 49), kRadius),
                  make_particle("shot", kind, Vec3(-0.1, 0, 0) + aim, kShot)};
  scene.bodies[1].velocity = {part * std::sqrt(2 * barrier / reduced_mass), 0, 0};
  take_stable_step(scene, 0.2);
  return scene;
}

void add_shots_at_plates(Cases& cases) {
  for (const bool between : {false, true}) {
    for (const BodyKind kind : {BodyKind::liquid, BodyKind::rigid}) {
      for (const Real part : {0.3, 0.9, 3.0}) {
        const std::string where = between ? "between particles of a plate" : "on a plate";
        AdversarialCase shot{.group = "shot " + where,
                             .name = std::string(to_string(kind)) + " shot " + where + " with " +
                                     label(part) + " of the speed it bears",
                             .scene = make_plate(between, part, kind),
                             .duration = 0.1};
        const Real kept = part < 1 ? -1 : 1;  // side of the plate on which the projectile must end
        shot.judge = [kept](const Simulation& simulation) {
          const Real x = test::position_of(simulation, 1).x() -
                         simulation.bodies()[0].pose->center_of_mass.x();
          return kept * x > 0 ? std::string() : "the shot is at " + label(x) + " m of the plate";
        };
        cases.push_back(shot);
      }
    }
  }
}

/// Makes walls and liquid stiff enough for a block of n^3 particles that falls through `height`
/// under `acceleration`.
void stiffen(Scene& scene, int n, Real acceleration, Real height) {
  const Real mass = 0.125 * n * n * n;  // a rigid block may land on one corner
  const Real speed2 = 2 * acceleration * height;
  for (auto& interface : scene.interfaces) {
    interface.constants.stiffness = std::max(1e4, 4 * mass * speed2 / (kRadius * kRadius));
  }
  for (Material& material : scene.materials) {
    if (material.liquid) material.liquid->stiffness = std::max(100.0, 10 * acceleration * height);
  }
}

void add_heavy_vats(Cases& cases) {
  constexpr Real kEarth = 9.81;
  for (const BodyKind kind : kKinds) {
    for (const Real times : {1.0, 10.0, 50.0}) {
      for (const Real tilt : {0.0, 30.0, 80.0}) {
        const Real angle = tilt * std::numbers::pi / 180;
        Scene scene = make_tank();
        scene.gravity = times * kEarth * Vec3(std::sin(angle), 0, -std::cos(angle));
        scene.bodies = {make_block("block", kind, 4, {0.5, 0.5, 0.1})};
        stiffen(scene, 4, times * kEarth, 0.5);
        take_stable_step(scene, 0.25);
        cases.push_back({.group = std::string("tilted vat: ") + to_string(kind),
                         .name = std::string(to_string(kind)) + " in a vat of " + label(times) +
                                 " g, tilted by " + label(tilt),
                         .scene = scene,
                         .duration = 0.3});
      }
      Scene scene = make_tank();
      const Real omega = 2 * std::numbers::pi / 0.2;
      const Real stroke = 2 * times * kEarth / (omega * omega);
      scene.vat->motion = SlideMotion{Vec3::UnitX(), stroke, 0.2};
      scene.bodies = {make_block("block", kind, 4, {0.5, 0.5, 0.1})};
      stiffen(scene, 4, times * kEarth, stroke);
      take_stable_step(scene, 0.25);
      cases.push_back(
          {.group = std::string("shaken vat: ") + to_string(kind),
           .name = std::string(to_string(kind)) + " in a vat shaken with " + label(times) + " g",
           .scene = scene});
    }
  }
}

/// Walls that start suddenly with the vat's speed, next to bodies at rest.
void add_sudden_vats(Cases& cases) {
  for (const Real period : {1.0, 0.05, 0.001}) {
    Scene scene = make_tank();
    scene.vat->motion = SlideMotion{Vec3(1, 1, 0), 0.2, period};
    scene.bodies = {make_block("pool", BodyKind::liquid, 4, {0.125, 0.125, 0.1}),
                    make_block("cube", BodyKind::rigid, 3, {0.8, 0.8, 0.08})};
    cases.push_back({.group = "walls too fast for their stiffness",
                     .name = "vat shaken every " + label(period) + " s by soft walls",
                     .scene = scene,
                     .expected = Expected::may_stop});
  }
}

}  // namespace

void add_motion_cases(Cases& cases) {
  add_shots_at_walls(cases);
  add_shots_in_long_steps(cases);
  add_shots_at_plates(cases);
  add_heavy_vats(cases);
  add_sudden_vats(cases);
}

}  // namespace vat::stability
