#include <algorithm>

#include "core/limits.h"
#include "core/sampling/mesh.h"
#include "core/validation/validate_parts.h"

namespace vat {
namespace {

bool check_values(const BoxShape& box, const std::string& path, RangeCheck& check) {
  const bool center = check.vector(box.center, -kMaxLength, kMaxLength, path + "/center");
  return check.vector(box.size, kMinLength, kMaxLength, path + "/size") && center;
}

bool check_values(const SphereShape& sphere, const std::string& path, RangeCheck& check) {
  const bool center = check.vector(sphere.center, -kMaxLength, kMaxLength, path + "/center");
  return check.real(sphere.radius, kMinLength, kMaxLength, path + "/radius") && center;
}

bool check_values(const CylinderShape& cylinder, const std::string& path, RangeCheck& check) {
  bool fine = check.vector(cylinder.center, -kMaxLength, kMaxLength, path + "/center");
  fine &= check.real(cylinder.radius, kMinLength, kMaxLength, path + "/radius");
  fine &= check.real(cylinder.height, kMinLength, kMaxLength, path + "/height");
  if (!check.vector(cylinder.axis, -kMaxLength, kMaxLength, path + "/axis")) return false;
  if (cylinder.axis.norm() >= kMinLength) return fine;
  check.add("out_of_range", path + "/axis", "must not be the zero vector");
  return false;
}

bool check_corners(const MeshShape& mesh, const std::string& path, RangeCheck& check) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const std::string at = path + "/vertices/" + std::to_string(v);
    if (!check.vector(mesh.vertices[v], -kMaxLength, kMaxLength, at)) return false;
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (std::ranges::max(mesh.triangles[t]) < mesh.vertices.size()) continue;
    check.add("out_of_range", path + "/triangles/" + std::to_string(t),
              "must be three numbers below the number of vertices, " +
                  std::to_string(mesh.vertices.size()));
    return false;
  }
  return true;
}

bool check_values(const MeshShape& mesh, const std::string& path, RangeCheck& check) {
  if (mesh.triangles.size() > kMaxMeshTriangles) {
    check.add("too_many", path,
              "a mesh has at most " + std::to_string(kMaxMeshTriangles) + " triangles");
    return false;
  }
  if (!check_corners(mesh, path, check)) return false;
  if (!is_closed(mesh)) {
    check.add("open_mesh", path, "the mesh must be closed: each edge between two triangles");
    return false;
  }
  if (mesh_volume(mesh) > 0) return true;
  check.add("inverted_mesh", path,
            "the mesh must have a volume, its triangles counter-clockwise seen from outside");
  return false;
}

bool check_particle_values(const ParticleShape& shape, const std::string& path, RangeCheck& check) {
  bool fine = true;
  const auto each = [&](const char* name, const auto& values, auto&& fits) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      fine &= fits(values[i], path + name + std::to_string(i));
    }
  };
  each("/positions/", shape.positions, [&](const Vec3& value, const std::string& at) {
    return check.vector(value, -kMaxLength, kMaxLength, at);
  });
  each("/velocities/", shape.velocities, [&](const Vec3& value, const std::string& at) {
    return check.vector(value, -kMaxSpeed, kMaxSpeed, at);
  });
  each("/masses/", shape.masses, [&](Real value, const std::string& at) {
    return check.real(value, kMinMass, kMaxMass, at);
  });
  each("/radii/", shape.radii, [&](Real value, const std::string& at) {
    return check.real(value, kMinLength, kMaxLength, at);
  });
  return fine;
}

bool check_particle_counts(const ParticleShape& shape, const std::string& path, RangeCheck& check) {
  const std::size_t count = shape.positions.size();
  if (count == 0 || count > kMaxParticles) {
    check.add("out_of_range", path + "/positions",
              "must be 1 to " + std::to_string(kMaxParticles) + " positions");
    return false;
  }
  bool fine = true;
  const auto as_long = [&](std::size_t length, const char* name) {
    if (length == 0 || length == count) return;
    fine = false;
    check.add("wrong_length", path + name,
              "must be as long as the positions, " + std::to_string(count) + ", or left out");
  };
  as_long(shape.velocities.size(), "/velocities");
  as_long(shape.masses.size(), "/masses");
  as_long(shape.radii.size(), "/radii");
  return fine;
}

bool check_fixed(const BodyDescription& body, const ParticleShape& shape, const std::string& path,
                 RangeCheck& check) {
  if (!shape.fixed.empty() && body.kind != BodyKind::deformable) {
    check.add("not_allowed", path + "/fixed", "only a deformable body has fixed particles");
    return false;
  }
  bool fine = true;
  std::vector<Index> seen = shape.fixed;
  std::ranges::sort(seen);
  if (std::ranges::adjacent_find(seen) != seen.end()) {
    check.add("duplicate", path + "/fixed", "must not list a particle twice");
    fine = false;
  }
  for (std::size_t i = 0; i < shape.fixed.size(); ++i) {
    if (shape.fixed[i] < shape.positions.size()) continue;
    check.add("out_of_range", path + "/fixed/" + std::to_string(i),
              "must be below the number of particles, " + std::to_string(shape.positions.size()));
    fine = false;
  }
  return fine;
}

bool check_particles(const BodyDescription& body, const ParticleShape& shape,
                     const std::string& path, RangeCheck& check) {
  if (!check_particle_counts(shape, path, check)) return false;
  bool fine = check_particle_values(shape, path, check);
  fine &= check_fixed(body, shape, path, check);
  if (body.kind == BodyKind::rigid && !shape.velocities.empty()) {
    check.add("not_allowed", path + "/velocities",
              "a rigid body's particles move as one: give velocity and angular_velocity");
    fine = false;
  }
  return fine;
}

}  // namespace

bool check_shape(const BodyDescription& body, const std::string& path, RangeCheck& check) {
  if (const auto* particles = std::get_if<ParticleShape>(&body.shape)) {
    return check_particles(body, *particles, path, check);
  }
  return std::visit(
      [&](const auto& shape) {
        if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, ParticleShape>) {
          return true;
        } else {
          return check_values(shape, path, check);
        }
      },
      body.shape);
}

}  // namespace vat
