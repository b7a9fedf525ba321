#include <algorithm>

#include "core/validation/validate_parts.h"

namespace vat {
namespace {

/// Checks that values are in the plane of a two-dimensional scene, with one error for each member.
class PlaneCheck {
 public:
  explicit PlaneCheck(RangeCheck& check) : check_(check) {}

  void zero_y(const Vec3& value, const std::string& path) {
    if (value.y() != 0) add(path, "must have y = 0 in a scene of two dimensions");
  }
  void about_y(Real x, Real z, const std::string& path) {
    if (x != 0 || z != 0) add(path, "must rotate about y only in a scene of two dimensions");
  }
  void add(const std::string& path, const char* message) { check_.add("off_plane", path, message); }

 private:
  RangeCheck& check_;
};

void check_list(const std::vector<Vec3>& values, const std::string& path, PlaneCheck& plane) {
  const auto off = std::ranges::find_if(values, [](const Vec3& v) { return v.y() != 0; });
  if (off != values.end()) {
    plane.zero_y(*off, path + '/' + std::to_string(off - values.begin()));
  }
}

void check_form(const BoxShape& box, const std::string& path, PlaneCheck& plane) {
  plane.zero_y(box.center, path + "/center");
}
void check_form(const SphereShape& sphere, const std::string& path, PlaneCheck& plane) {
  plane.zero_y(sphere.center, path + "/center");
}
void check_form(const ParticleShape& particles, const std::string& path, PlaneCheck& plane) {
  check_list(particles.positions, path + "/positions", plane);
  check_list(particles.velocities, path + "/velocities", plane);
}
template <class Other>
void check_form(const Other&, const std::string& path, PlaneCheck& plane) {
  plane.add(path, "must be a box, a sphere or particles in a scene of two dimensions");
}

void check_field(const std::optional<VectorField>& field, const std::string& path,
                 PlaneCheck& plane) {
  if (!field) return;
  if (!field->gradient.row(1).isZero(0) || !field->gradient.col(1).isZero(0)) {
    plane.add(path + "/gradient",
              "must have zeros in its second row and column in a scene of two dimensions");
  }
  for (std::size_t w = 0; w < field->waves.size(); ++w) {
    const std::string at = path + "/waves/" + std::to_string(w);
    plane.zero_y(field->waves[w].amplitude, at + "/amplitude");
    plane.zero_y(field->waves[w].wave_vector, at + "/wave_vector");
  }
}

}  // namespace

void check_plane(const Scene& scene, RangeCheck& check) {
  PlaneCheck plane(check);
  plane.zero_y(scene.gravity, "/gravity");
  if (scene.periodic && scene.periodic->axes[1]) {
    plane.add("/periodic/axes", "must not name y in a scene of two dimensions");
  }
  if (scene.central_field) plane.zero_y(scene.central_field->center, "/central_field/center");
  for (std::size_t e = 0; e < scene.emitters.size(); ++e) {
    const std::string path = "/emitters/" + std::to_string(e);
    plane.zero_y(scene.emitters[e].position, path + "/position");
    plane.zero_y(scene.emitters[e].direction, path + "/direction");
  }
  if (!scene.vat) return;
  if (scene.vat->motion) plane.zero_y(scene.vat->motion->axis, "/vat/motion/axis");
  for (std::size_t wall = 0; wall < scene.vat->walls.size(); ++wall) {
    if (wall / 2 == 1) continue;  // does not exist
    plane.zero_y(scene.vat->walls[wall].velocity,
                 std::string("/vat/walls/") + kWallNames[wall] + "/velocity");
  }
}

void check_body_in_plane(const BodyDescription& body, const std::string& path, RangeCheck& check) {
  PlaneCheck plane(check);
  std::visit([&](const auto& form) { check_form(form, path + "/shape", plane); }, body.shape);
  plane.zero_y(body.position, path + "/position");
  plane.zero_y(body.velocity, path + "/velocity");
  plane.about_y(body.orientation.x(), body.orientation.z(), path + "/orientation");
  plane.about_y(body.angular_velocity.x(), body.angular_velocity.z(), path + "/angular_velocity");
  if (body.motion) plane.zero_y(body.motion->axis, path + "/motion/axis");
  if (body.axle) {
    plane.about_y(body.axle->direction.x(), body.axle->direction.z(), path + "/axle/direction");
  }
  check_field(body.velocity_field, path + "/velocity_field", plane);
  check_field(body.displacement_field, path + "/displacement_field", plane);
}

}  // namespace vat
