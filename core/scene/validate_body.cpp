#include <algorithm>
#include <cmath>

#include "core/limits.h"
#include "core/scene/lattice.h"
#include "core/scene/sampling.h"
#include "core/scene/validate_parts.h"

namespace vat {
namespace {

constexpr Real kUnitTolerance = 1e-3;  // of a quaternion's length: rounded in a file, no mistake

const Material* check_material(const Scene& scene, const BodyDescription& body,
                               const std::string& path, RangeCheck& check) {
  const auto found = std::ranges::find(scene.materials, body.material, &Material::name);
  if (found == scene.materials.end()) {
    check.add("unknown_name", path + "/material",
              "must be the name of one of the scene's materials");
    return nullptr;
  }
  if (body.kind == BodyKind::liquid && !found->liquid) {
    check.add("not_liquid", path + "/material",
              "must be a material with liquid constants, since the body is liquid");
    return nullptr;
  }
  return &*found;
}

void check_motion(const BodyDescription& body, const std::string& path, RangeCheck& check) {
  check.vector(body.position, -kMaxLength, kMaxLength, path + "/position");
  check.vector(body.velocity, -kMaxSpeed, kMaxSpeed, path + "/velocity");
  check.vector(body.angular_velocity, -kMaxAngularSpeed, kMaxAngularSpeed,
               path + "/angular_velocity");
  if (!(std::abs(body.orientation.norm() - 1) <= kUnitTolerance)) {
    check.add("out_of_range", path + "/orientation",
              "must be a quaternion [w, x, y, z] of length 1 (within 0.001)");
  }
}

/// Spacing, mass and radius: given where nothing else tells them, and in range.
bool check_sizes(const BodyDescription& body, const std::string& path, RangeCheck& check) {
  bool fine = true;
  if (body.mass) fine &= check.real(*body.mass, kMinMass, kMaxMass, path + "/mass");
  if (body.radius) fine &= check.real(*body.radius, kMinLength, kMaxLength, path + "/radius");
  const auto* particles = std::get_if<ParticleShape>(&body.shape);
  const bool has_spacing = body.spacing != 0;
  if (particles == nullptr || has_spacing) {
    return check.real(body.spacing, kMinLength, kMaxLength, path + "/spacing") && fine;
  }
  if (particles->masses.empty() && !body.mass) {
    check.add("missing", path + "/mass", "must be given, or a spacing, or the particles' masses");
    fine = false;
  }
  if (particles->radii.empty() && !body.radius) {
    check.add("missing", path + "/radius", "must be given, or a spacing, or the particles' radii");
    fine = false;
  }
  return fine;
}

void check_springs(const BodyDescription& body, std::size_t particles, const std::string& path,
                   RangeCheck& check) {
  if (!body.springs.empty() && body.kind != BodyKind::deformable) {
    check.add("not_allowed", path + "/springs", "only a deformable body has springs");
    return;
  }
  for (std::size_t s = 0; s < body.springs.size(); ++s) {
    const SpringDescription& spring = body.springs[s];
    const std::string at = path + "/springs/" + std::to_string(s);
    if (spring.a >= particles || spring.b >= particles || spring.a == spring.b) {
      check.add("out_of_range", at + "/particles",
                "must be two different numbers below the number of particles, " +
                    std::to_string(particles));
    }
    check_constants(spring.constants, at, check);
    if (spring.rest_length) check.real(*spring.rest_length, 0, kMaxLength, at + "/rest_length");
  }
}

std::size_t lattice_spring_count(const BodyDescription& body, const Material& material,
                                 const std::vector<LatticePoint>& points) {
  if (body.kind != BodyKind::deformable || !material.springs) return 0;
  const LatticeSprings& springs = *material.springs;
  const std::size_t each =
      (springs.structural ? 3u : 0u) + (springs.shear ? 6u : 0u) + (springs.bend ? 3u : 0u);
  return each * points.size();  // an upper bound: a limit that is easy to explain
}

void check_inside_vat(const Vat& vat, const BodyDescription& body, const Material& material,
                      const std::string& path, RangeCheck& check) {
  for (const Vec3& position : sample_body(body, material).positions) {
    const bool above_floor = (position.array() > vat.min.array()).all();
    const bool between_sides = position.x() < vat.max.x() && position.y() < vat.max.y();
    const bool below_lid = !vat.lid || position.z() < vat.max.z();
    if (above_floor && between_sides && below_lid) continue;
    check.add("outside_vat", path, "must start inside the vat, with every particle's centre");
    return;
  }
}

}  // namespace

BodySize check_body(const Scene& scene, const BodyDescription& body, const std::string& path,
                    RangeCheck& check) {
  check.text(body.name, kMaxNameLength, false, path + "/name");
  Errors own;
  RangeCheck own_check(own);
  const Material* material = check_material(scene, body, path, own_check);
  check_motion(body, path, own_check);
  bool can_sample = check_sizes(body, path, own_check);
  can_sample &= check_shape(body, path + "/shape", own_check);

  BodySize size;
  if (const auto* particles = std::get_if<ParticleShape>(&body.shape)) {
    size.particles = particles->positions.size();
  } else if (can_sample && material != nullptr) {
    const Lattice lattice = make_lattice(body.shape, body.spacing);
    if (const char* excess = lattice_excess(body.shape, lattice)) {
      own_check.add("too_many", path + "/spacing", excess);
      can_sample = false;
    } else {
      const std::vector<LatticePoint> points = fill_lattice(body.shape, lattice);
      size.particles = points.size();
      size.springs = lattice_spring_count(body, *material, points);
      if (points.empty()) {
        own_check.add("no_particles", path + "/spacing",
                      "is too large: no lattice point lies inside the shape");
        can_sample = false;
      }
    }
  }
  if (can_sample) check_springs(body, size.particles, path, own_check);
  size.springs += body.springs.size();
  if (own.empty() && scene.vat && size.particles <= kMaxParticles && size.springs <= kMaxSprings) {
    check_inside_vat(*scene.vat, body, *material, path, own_check);
  }
  for (Error& error : own) {
    check.add(std::move(error.code), std::move(error.path), std::move(error.message));
  }
  return own.empty() ? size : BodySize{};
}

}  // namespace vat
