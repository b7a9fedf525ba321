#pragma once

#include <string>

#include "tests/support/scenes.h"

namespace vat::test {

inline constexpr Real kBlockSpacing = 0.05;  // [m]

/// Returns a scene with two materials, "a" and "b", that suit any body kind. All springs and
/// contacts have a ratio of damping to stiffness of 2 ms. Explicit Euler is stable for steps below
/// that ratio.
inline Scene make_two_material_scene(IntegratorId integrator, Real step, Real viscosity = 0) {
  Scene scene = make_scene(integrator, step);
  for (const char* name : {"a", "b"}) {
    scene.materials.push_back(make_liquid(name, 1000, {100, viscosity, 2 * kBlockSpacing}));
    scene.materials.back().self_contact = SpringConstants{500, 1};
  }
  scene.default_interface = {500, 1};
  return scene;
}

/// n^3 particles of 0.125 kg around `center`. If the body is deformable, springs join near
/// neighbours.
inline BodyDescription make_block(std::string name, BodyKind kind, std::string material, int n,
                                  const Vec3& center, const Vec3& velocity) {
  std::vector<Vec3> points = make_lattice(n, n, n, kBlockSpacing);
  BodyDescription body = make_body(std::move(name), kind, std::move(material),
                                   make_particles(points, 0.125), kBlockSpacing / 2);
  body.position = center;
  body.velocity = velocity;
  if (kind == BodyKind::deformable) {
    body.springs = join_near(points, 1.5 * kBlockSpacing, {2000, 4});
  }
  if (kind == BodyKind::rigid) body.angular_velocity = {1, -2, 3};
  return body;
}

/// Two rotating blocks of 27 particles that approach each other off-centre.
inline Scene make_collision(BodyKind first, BodyKind second, IntegratorId integrator, Real step) {
  Scene scene = make_two_material_scene(integrator, step);
  scene.bodies = {make_block("first", first, "a", 3, {-0.09, 0.01, 0.02}, {1, 0.4, 0}),
                  make_block("second", second, "b", 3, {0.09, 0, 0}, {-1, 0, 0.3})};
  return scene;
}

/// A body of each kind with 343 particles, in contact with one another and the floor of a sliding
/// vat.
inline Scene make_crowd(IntegratorId integrator, Real step) {
  Scene scene = make_two_material_scene(integrator, step, 1);
  scene.gravity = {0, 0, -9.81};
  scene.vat = Vat{{-0.25, -0.25, -0.16}, {1, 1, 1.3}, true, SlideMotion{{1, 0, 0}, 0.2, 2}};
  scene.bodies = {make_block("pool", BodyKind::liquid, "a", 7, {0, 0, 0}, {0.3, 0.1, 0}),
                  make_block("jelly", BodyKind::deformable, "b", 7, {0.02, 0, 0.33}, {0, 0, -1}),
                  make_block("crate", BodyKind::rigid, "a", 7, {0, 0.03, 0.66}, {0, 0, -1})};
  return scene;
}

/// Liquids of two densities, a deformable and a rigid body, all in contact.
inline Scene make_wet_mixture(IntegratorId integrator, PressureSolver solver) {
  Scene scene = make_two_material_scene(integrator, 1e-3, 5);
  scene.pressure_solver = solver;
  scene.pair_precision = PairPrecision::double_precision;
  scene.materials[1].density = 700;
  const auto add = [&](const char* name, BodyKind kind, const char* material, const Vec3& center,
                       const Vec3& velocity) {
    scene.bodies.push_back(make_block(name, kind, material, 4, center, velocity));
  };
  add("water", BodyKind::liquid, "a", {0, 0, 0}, {0.3, 0, 0});
  add("oil", BodyKind::liquid, "b", {0.2, 0, 0}, {-0.5, 0.1, 0});
  add("jelly", BodyKind::deformable, "a", {0, 0.2, 0.05}, {0, -0.5, 0});
  add("crate", BodyKind::rigid, "b", {0.1, 0, 0.2}, {0, 0, -0.4});
  return scene;
}

}  // namespace vat::test
