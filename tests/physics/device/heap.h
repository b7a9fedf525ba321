#pragma once

#include <string>
#include <utility>

#include "core/simulation/simulation.h"
#include "tests/support/scenes.h"

/// A heap of rigid bodies.
namespace vat::test {

inline constexpr Real kHeapSpacing = 0.04;  // [m]

inline BodyDescription make_rigid(const std::string& name, const Vec3& position,
                                  const Shape& shape) {
  BodyDescription body{name, BodyKind::rigid, "wood", shape, kHeapSpacing};
  body.position = position;
  return body;
}

/// A plate, a ball and a rod that spin and fall on the floor, on a wall, and on each other.
inline Scene make_heap() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_material("wood", 600)};
  scene.default_interface = {20000, 10};
  scene.vat = Vat{{0, 0, 0}, {0.6, 0.4, 0.8}, false, {}};
  scene.bodies = {make_rigid("plate", {0.15, 0.2, 0.1}, BoxShape{Vec3::Zero(), {0.2, 0.16, 0.08}}),
                  make_rigid("ball", {0.2, 0.22, 0.28}, SphereShape{Vec3::Zero(), 0.08}),
                  make_rigid("rod", {0.3, 0.2, 0.46}, BoxShape{Vec3::Zero(), {0.32, 0.08, 0.08}})};
  scene.bodies[0].velocity = {-1, 0, -1};
  scene.bodies[0].angular_velocity = {1, 2, 0.5};
  scene.bodies[1].velocity = {-0.5, 0.2, -1};
  scene.bodies[1].angular_velocity = {4, -3, 2};
  scene.bodies[2].velocity = {0, 0, -2};
  scene.bodies[2].angular_velocity = {-5, 1, 3};
  scene.bodies[2].orientation = Quat(0.8, 0.1, 0.3, 0.2).normalized();
  return scene;
}

/// Puts 30 small bodies on the plate, more than a device lists as near it.
inline void add_small_bodies(Scene& scene) {
  scene.vat->max.z() = 1;
  scene.bodies[1].position.z() = 0.5;
  scene.bodies[2].position.z() = 0.8;
  for (int n = 0; n < 30; ++n) {
    BodyDescription body =
        make_body("small " + std::to_string(n), BodyKind::rigid, "wood",
                  make_particles({{0, 0, 0}, {0, 0, 0.03}}, 0.02), kHeapSpacing / 2);
    body.position = {0.06 + 0.045 * (n % 5), 0.1 + 0.045 * (n / 5), 0.155};
    body.velocity = {-1, 0, -1.5};
    scene.bodies.push_back(std::move(body));
  }
}

/// Changes a heap to one in two dimensions.
inline void set_plane_of_heap(Scene& scene) {
  scene.dimensions = 2;
  scene.materials[0].density = 24;  // with masses of the same size as in three dimensions
  for (BodyDescription& body : scene.bodies) {
    body.position.y() = 0;
    body.velocity.y() = 0;
    body.orientation.setIdentity();
    body.angular_velocity = {0, 3, 0};
  }
  scene.vat->min.y() = -1;
  scene.vat->max.y() = 1;
}

/// Adds a deformable body beside the heap.
inline void add_jelly(Scene& scene) {
  scene.materials.push_back(make_material("jelly", 400));
  scene.materials[1].springs =
      LatticeSprings{SpringConstants{600, 1}, SpringConstants{300, 0.5}, SpringConstants{150, 0.2}};
  BodyDescription jelly{"jelly", BodyKind::deformable, "jelly",
                        BoxShape{Vec3::Zero(), {0.16, 0.16, 0.12}}, kHeapSpacing};
  jelly.position = {0.45, 0.2, 0.1};
  jelly.velocity = {-1, 0, -1};
  scene.bodies.push_back(std::move(jelly));
}

}  // namespace vat::test
