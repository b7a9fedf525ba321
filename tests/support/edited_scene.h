#pragma once

#include <span>
#include <vector>

#include "tests/support/scenes.h"

namespace vat::test {

/// A body of each kind in a vat, sampled from shapes that are not centred at their origins.
inline Scene sampled_scene() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.pressure_solver = PressureSolver::tait;
  scene.gravity = {0, 0, -9.81};
  Material jelly = make_material("jelly", 900);
  jelly.springs = LatticeSprings{SpringConstants{500, 0.5}, SpringConstants{300, 0.3}, {}};
  scene.materials = {make_liquid("water", 1000, {.stiffness = 100, .support_radius = 0.125}), jelly,
                     make_material("wood", 600)};
  scene.vat = Vat{{0, 0, 0}, {1, 1, 1}, true, {}, {}};
  const auto add = [&](const char* name, BodyKind kind, const char* material, const Vec3& center,
                       Real size) {
    BodyDescription body;
    body.name = name;
    body.kind = kind;
    body.material = material;
    body.spacing = 0.05;
    body.shape = BoxShape{{0.01, 0.02, 0.03}, Vec3::Constant(size)};  // not centred at the origin
    body.position = center;
    scene.bodies.push_back(body);
  };
  add("pool", BodyKind::liquid, "water", {0.25, 0.25, 0.2}, 0.3);
  add("cube", BodyKind::deformable, "jelly", {0.7, 0.7, 0.3}, 0.2);
  add("crate", BodyKind::rigid, "wood", {0.3, 0.7, 0.3}, 0.2);
  scene.bodies[2].orientation = Quat(Eigen::AngleAxis<Real>(0.3, Vec3(1, 2, 3).normalized()));
  scene.bodies[2].angular_velocity = {1, -2, 0.5};
  return scene;
}

/// Adds a tap above, from which the pool grows.
inline Scene scene_with_tap(Scene scene = sampled_scene()) {
  scene.emitters = {{.name = "tap",
                     .body = "pool",
                     .position = {0.5, 0.5, 0.8},
                     .radius = 0.05,
                     .speed = 0.5,
                     .most_particles = 5000}};
  return scene;
}

template <class T>
std::vector<T> copy_of(std::span<const T> values) {
  return {values.begin(), values.end()};
}

}  // namespace vat::test
