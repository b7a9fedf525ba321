#include "tests/stability/transform.h"

#include <algorithm>
#include <array>
#include <utility>

namespace vat::stability {
namespace {

ParticleShape& particles_of(BodyDescription& body) {
  return std::get<ParticleShape>(body.shape);
}

Vec3 mirror(const Vec3& v) {
  return {-v.x(), v.y(), v.z()};
}

/// Mirrors an axis of rotation.
Vec3 mirror_axis(const Vec3& v) {
  return {v.x(), -v.y(), -v.z()};
}

}  // namespace

Scene rotated(Scene scene, const Quat& rotation) {
  scene.gravity = rotation * scene.gravity;
  for (BodyDescription& body : scene.bodies) {
    body.position = rotation * body.position;
    body.orientation = rotation * body.orientation;
    body.velocity = rotation * body.velocity;
    body.angular_velocity = rotation * body.angular_velocity;
  }
  return scene;
}

Scene translated(Scene scene, const Vec3& offset) {
  for (BodyDescription& body : scene.bodies) body.position += offset;
  if (scene.vat) {
    scene.vat->min += offset;
    scene.vat->max += offset;
  }
  return scene;
}

Scene in_moving_frame(Scene scene, const Vec3& velocity) {
  for (BodyDescription& body : scene.bodies) body.velocity += velocity;
  return scene;
}

Scene mirrored(Scene scene) {
  scene.gravity = mirror(scene.gravity);
  for (BodyDescription& body : scene.bodies) {
    body.position = mirror(body.position);
    const Vec3 axis = mirror_axis(body.orientation.vec());
    body.orientation = Quat(body.orientation.w(), axis.x(), axis.y(), axis.z());
    body.velocity = mirror(body.velocity);
    body.angular_velocity = mirror_axis(body.angular_velocity);
    for (Vec3& position : particles_of(body).positions) position = mirror(position);
    for (Vec3& velocity : particles_of(body).velocities) velocity = mirror(velocity);
  }
  if (scene.vat) {
    const Vec3 min = mirror(scene.vat->min);
    const Vec3 max = mirror(scene.vat->max);
    scene.vat->min = min.cwiseMin(max);
    scene.vat->max = min.cwiseMax(max);
    if (scene.vat->motion) scene.vat->motion->axis = mirror(scene.vat->motion->axis);
  }
  return scene;
}

Scene renumbered(Scene scene) {
  std::ranges::reverse(scene.bodies);
  for (BodyDescription& body : scene.bodies) {
    ParticleShape& shape = particles_of(body);
    const auto last = static_cast<Index>(shape.positions.size() - 1);
    std::ranges::reverse(shape.positions);
    std::ranges::reverse(shape.velocities);
    std::ranges::reverse(shape.masses);
    std::ranges::reverse(shape.radii);
    for (Index& fixed : shape.fixed) fixed = last - fixed;
    std::ranges::reverse(body.springs);
    for (SpringDescription& spring : body.springs) {
      spring.a = last - spring.a;
      spring.b = last - spring.b;
    }
  }
  return scene;
}

}  // namespace vat::stability
