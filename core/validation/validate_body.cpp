#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/limits.h"
#include "core/validation/validate_parts.h"

namespace vat {
namespace {

const Material* check_material(const Scene& scene, const BodyDescription& body,
                               const std::string& path, RangeCheck& check) {
  const auto found = std::ranges::find(scene.materials, body.material, &Material::name);
  if (found == scene.materials.end()) {
    check.add_unknown(path + "/material", "must be the name of one of the scene's materials",
                      body.material, scene.materials, &Material::name);
    return nullptr;
  }
  if (body.kind == BodyKind::liquid && !found->liquid) {
    check.add("not_liquid", path + "/material",
              "must be a material with liquid constants, since the body is liquid");
    return nullptr;
  }
  return &*found;
}

/// Checks that mass and radius are given either for the body or for the particles of the shape.
bool check_lists(const BodyDescription& body, const ParticleShape& particles,
                 const std::string& path, RangeCheck& check) {
  bool fine = true;
  const auto need_one = [&](bool listed, bool given, const std::string& name, const char* lists) {
    if (listed && given) {
      check.add("not_allowed", path + name,
                std::string("must be left out, since the shape lists the particles' ") + lists);
    } else if (!listed && !given && body.spacing == 0) {
      check.add("missing", path + name,
                std::string("must be given, or a spacing, or the particles' ") + lists);
    } else {
      return;
    }
    fine = false;
  };
  need_one(!particles.masses.empty(), body.mass.has_value(), "/mass", "masses");
  need_one(!particles.radii.empty(), body.radius.has_value(), "/radius", "radii");
  return fine;
}

/// Checks spacing, mass and radius: their ranges, and that each follows from one source.
bool check_sizes(const BodyDescription& body, const std::string& path, RangeCheck& check) {
  bool fine = true;
  if (body.mass) fine &= check.real(*body.mass, kMinMass, kMaxMass, path + "/mass");
  if (body.radius) fine &= check.real(*body.radius, kMinLength, kMaxLength, path + "/radius");
  const auto* particles = std::get_if<ParticleShape>(&body.shape);
  if (particles == nullptr || body.spacing != 0) {
    fine &= check.real(body.spacing, kMinLength, kMaxLength, path + "/spacing");
  }
  if (particles != nullptr) fine &= check_lists(body, *particles, path, check);
  return fine;
}

/// Checks the reach of a sampled body against its spacing, which bounds the number of neighbours.
void check_ratios(const BodyDescription& body, const Material& material, const std::string& path,
                  RangeCheck& check) {
  if (std::holds_alternative<ParticleShape>(body.shape)) return;
  if (body.kind == BodyKind::liquid) {
    check.real(body.spacing, material.liquid->support_radius / kMaxReachInSpacings, kMaxLength,
               path + "/spacing");
  }
  if (body.radius) {
    check.real(*body.radius, kMinLength, kMaxRadiusInSpacings * body.spacing, path + "/radius");
  }
}

void check_surface_support(const Scene& scene, const Material& material, const SampledBody& sample,
                           const std::string& path, RangeCheck& check) {
  if (!material.liquid || material.liquid->surface_tension == 0 || sample.masses.empty()) return;
  constexpr Real kRounding = 1 + 1e-9;
  const Real volume = std::ranges::max(sample.masses) / material.density;
  const Real spacing = scene.dimensions == 3 ? std::cbrt(volume) : std::sqrt(volume);
  const Real least = min_surface_support(scene.surface_model == SurfaceModel::cohesion);
  const Real greatest = material.liquid->support_radius / least;
  if (spacing <= greatest * kRounding) return;
  std::ostringstream message;
  message << "must be at most " << greatest
          << " m for a liquid with surface tension: its support radius is at least " << least
          << " spacings";
  check.add("out_of_range", path + "/spacing", message.str());
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
    check_members(spring.constants, at, check);
    if (spring.rest_length) check.real(*spring.rest_length, 0, kMaxLength, at + "/rest_length");
  }
}

std::size_t lattice_spring_count(const BodyDescription& body, const Material& material,
                                 const std::vector<LatticePoint>& points) {
  if (body.kind != BodyKind::deformable || !material.springs) return 0;
  const LatticeSprings& springs = *material.springs;
  return springs_per_point(springs) * points.size();  // an upper bound, simple to explain
}

struct BodySize {
  std::size_t particles = 0;
  std::size_t lattice_springs = 0;
};

/// The size of a body whose shape and spacing are valid; empty if it cannot be sampled.
std::optional<BodySize> measure_lattice(const BodyDescription& body, const Material& material,
                                        int dimensions, const std::string& path,
                                        Allowance& allowance, RangeCheck& check) {
  if (allowance.is_exceeded()) return {};
  const Lattice lattice = make_lattice(body.shape, body.spacing, dimensions);
  if (const char* excess = allowance.take_lattice(body.shape, lattice)) {
    check.add("too_many", path + "/spacing", excess);
    return {};
  }
  const std::vector<LatticePoint> points = fill_lattice(body.shape, lattice);
  if (points.empty()) {
    check.add("no_particles", path + "/spacing",
              "is too large: no lattice point lies inside the shape");
    return {};
  }
  return BodySize{points.size(), lattice_spring_count(body, material, points)};
}

std::optional<BodySize> measure_body(const BodyDescription& body, const Material* material,
                                     int dimensions, const std::string& path, Allowance& allowance,
                                     RangeCheck& check) {
  bool can_sample = check_sizes(body, path, check);
  const auto* mesh = std::get_if<MeshShape>(&body.shape);
  if (const char* excess = mesh == nullptr ? nullptr : allowance.take_mesh(*mesh)) {
    check.add("too_many", path + "/shape", excess);
    return {};
  }
  can_sample &= check_shape(body, path + "/shape", check);
  if (!can_sample) return {};
  if (const auto* particles = std::get_if<ParticleShape>(&body.shape)) {
    return BodySize{particles->positions.size(), 0};
  }
  if (material == nullptr) return {};
  return measure_lattice(body, *material, dimensions, path, allowance, check);
}

}  // namespace

bool is_inside_vat(const Scene& scene, const Vec3& p) {
  const Vat& vat = *scene.vat;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (scene.periodic && scene.periodic->axes[static_cast<std::size_t>(axis)]) continue;
    const bool is_open_above = axis == 2 && !vat.lid;
    if (!(p[axis] > vat.min[axis] && (is_open_above || p[axis] < vat.max[axis]))) return false;
  }
  return true;
}

void check_inside_vat(const Scene& scene, const Vec3& offset, std::span<const Vec3> positions,
                      const std::string& path, RangeCheck& check) {
  for (const Vec3& position : positions) {
    if (is_inside_vat(scene, position - offset)) continue;
    check.add("outside_vat", path, "must start inside the vat, with every particle's centre");
    return;
  }
}

std::optional<SampledBody> check_body(const Scene& scene, const Vec3& vat_offset,
                                      const BodyDescription& body, const std::string& path,
                                      Allowance& allowance, RangeCheck& check) {
  check.text(body.name, kMaxNameLength, false, path + "/name");
  Errors own;
  RangeCheck own_check(own);
  const Material* material = check_material(scene, body, path, own_check);
  check_motion(body, path, own_check);
  if (body.melting) {
    const std::string at = path + "/melting";
    own_check.real(body.melting->at, 0, kMaxRelease, at + "/at");
    check_melting(scene, body, body.melting->into, at, at + "/into", own_check);
  }
  if (scene.dimensions == 2) check_body_in_plane(body, path, own_check);
  if (const auto size =
          measure_body(body, material, scene.dimensions, path, allowance, own_check)) {
    check_springs(body, size->particles, path, own_check);
    allowance.take_particles(size->particles);
    allowance.take_springs(size->lattice_springs + body.springs.size());
  }
  if (own.empty()) check_ratios(body, *material, path, own_check);
  std::optional<SampledBody> sample;
  if (own.empty() && !allowance.is_exceeded()) {
    sample = sample_body(body, *material, scene.dimensions);
    check_start(body, *sample, path, own_check);
    if (body.kind == BodyKind::liquid) {
      check_surface_support(scene, *material, *sample, path, own_check);
    }
    if (scene.vat) check_inside_vat(scene, vat_offset, sample->positions, path, own_check);
  }
  if (!own.empty()) sample.reset();
  for (Error& error : own) {
    check.add(std::move(error.code), std::move(error.path), std::move(error.message));
  }
  return sample;
}

const char* Allowance::take_mesh(const MeshShape& mesh) {
  triangles_ += mesh.triangles.size();
  if (triangles_ <= kMaxSceneTriangles) return nullptr;
  exceeded_ = true;
  return "the scene's meshes may have at most 1000000 triangles in all";
}

const char* Allowance::take_lattice(const Shape& shape, const Lattice& lattice) {
  const auto* mesh = std::get_if<MeshShape>(&shape);
  const Real points = lattice.point_count();
  const Real work = mesh == nullptr ? 0 : lattice_work(*mesh, lattice);
  const bool is_too_fine = points > static_cast<Real>(kMaxLatticePoints);
  const bool is_too_much = work > static_cast<Real>(kMaxMeshWork);
  if (!is_too_fine && !is_too_much) {
    lattice_points_ += points;
    mesh_work_ += work;
  }
  if (is_too_fine || lattice_points_ > static_cast<Real>(kMaxLatticePoints)) {
    exceeded_ |= !is_too_fine;
    return "is too small: the shapes' bounding boxes may hold at most 8000000 lattice points in "
           "all";
  }
  if (is_too_much || mesh_work_ > static_cast<Real>(kMaxMeshWork)) {
    exceeded_ |= !is_too_much;
    return "is too small: the meshes' triangles may cover at most 20000000 lattice columns in all";
  }
  return nullptr;
}

void Allowance::take_particles(std::size_t count) {
  particles_ += count;
  exceeded_ |= particles_ > kMaxParticles;
}

void Allowance::take_springs(std::size_t count) {
  springs_ += count;
  exceeded_ |= springs_ > kMaxSprings;
}

void Allowance::check_totals(const std::string& path, RangeCheck& check) const {
  if (particles_ > kMaxParticles) {
    check.add("too_many", path, "at most " + std::to_string(kMaxParticles) + " particles in all");
  }
  if (springs_ > kMaxSprings) {
    check.add("too_many", path, "at most " + std::to_string(kMaxSprings) + " springs in all");
  }
}

}  // namespace vat
