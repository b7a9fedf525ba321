#include "core/sampling/sampling.h"

#include <cmath>
#include <numbers>

#include "core/laws/cell_volume.h"
#include "core/sampling/jitter.h"
#include "core/sampling/lattice.h"
#include "core/sampling/mesh.h"
#include "core/scene/lookup.h"
#include "core/support/check.h"

namespace vat {
namespace {

using Offset = std::array<int, 3>;

/// Half of the neighbours of each kind. The other half are the same springs from the other end.
constexpr std::array<Offset, 3> kStructural{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr std::array<Offset, 6> kShear{
    {{1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}}};
constexpr std::array<Offset, 3> kBend{{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}};

/// Finds points by their lattice coordinates.
class LatticeIndex {
 public:
  LatticeIndex(const Lattice& lattice, const std::vector<LatticePoint>& points)
      : size_(lattice.size), index_(static_cast<std::size_t>(lattice.point_count()), kNone) {
    for (Index p = 0; p < points.size(); ++p) index_[slot(points[p].at)] = p;
  }

  std::optional<Index> find(const LatticePoint& from, const Offset& offset) const {
    std::array<Index, 3> at = from.at;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Real moved = static_cast<Real>(at[axis]) + offset[axis];
      if (moved < 0 || moved >= size_[axis]) return {};
      at[axis] = static_cast<Index>(moved);
    }
    const Index found = index_[slot(at)];
    return found == kNone ? std::nullopt : std::optional(found);
  }

 private:
  static constexpr Index kNone = ~Index{0};

  std::size_t slot(const std::array<Index, 3>& at) const {
    const auto width = static_cast<std::size_t>(size_[0]);
    const auto depth = static_cast<std::size_t>(size_[1]);
    return (at[2] * depth + at[1]) * width + at[0];
  }

  std::array<Real, 3> size_;
  std::vector<Index> index_;
};

/// The value of the field at the point `x` of the world.
Vec3 value_at(const VectorField& field, const Vec3& x) {
  Vec3 value = field.gradient * (x - field.center);
  for (const PlaneWave& wave : field.waves) {
    value += wave.amplitude * std::sin(wave.wave_vector.dot(x) + wave.phase);
  }
  return value;
}

template <std::size_t count>
void add_lattice_springs(const std::vector<LatticePoint>& points, const LatticeIndex& index,
                         const std::array<Offset, count>& offsets,
                         const std::optional<SpringConstants>& constants, SampledBody& sample) {
  if (!constants) return;
  for (Index a = 0; a < points.size(); ++a) {
    for (const Offset& offset : offsets) {
      if (const auto b = index.find(points[a], offset)) {
        const Real length = (sample.positions[a] - sample.positions[*b]).norm();
        sample.springs.push_back({a, *b, constants->stiffness, constants->damping, length});
      }
    }
  }
}

/// Adds the cells whose corners are all points of the body.
void add_lattice_cells(const std::vector<LatticePoint>& points, const LatticeIndex& index,
                       int dimensions, SampledBody& sample) {
  const Index count = dimensions == 3 ? 8 : 4;
  for (const LatticePoint& point : points) {
    SampledCell cell;
    Index found = 0;
    for (; found < count; ++found) {
      const auto bit = [&](Index b) { return static_cast<int>(found >> b & 1); };
      const Offset offset =
          dimensions == 3 ? Offset{bit(0), bit(1), bit(2)} : Offset{bit(0), 0, bit(1)};
      const auto corner = index.find(point, offset);
      if (!corner) break;
      cell.corners[found] = *corner;
    }
    if (found < count) continue;
    cell.volume = cell_volume(sample.positions, cell.corners, dimensions);
    sample.cells.push_back(cell);
  }
}

/// Mass of one lattice point [kg]; in two dimensions [kg/m].
Real point_mass(Real density, Real spacing, int dimensions) {
  const Real layer = density * spacing * spacing;
  return dimensions == 2 ? layer : layer * spacing;
}

void shift_at_random(const BodyDescription& body, int dimensions, SampledBody& sample) {
  if (body.jitter == 0) return;
  jitter(sample.positions, body.jitter * body.spacing, body.seed, dimensions);
}

Real lattice_mass(const BodyDescription& body, const Material& material, int dimensions,
                  std::size_t count) {
  if (body.mass) return *body.mass / static_cast<Real>(count);
  if (body.kind == BodyKind::liquid) return point_mass(material.density, body.spacing, dimensions);
  const Real size = dimensions == 2 ? shape_area(body.shape) : shape_volume(body.shape);
  return material.density * size / static_cast<Real>(count);
}

void sample_lattice(const BodyDescription& body, const Material& material, int dimensions,
                    SampledBody& sample) {
  const Lattice lattice = make_lattice(body.shape, body.spacing, dimensions);
  const std::vector<LatticePoint> points = fill_lattice(body.shape, lattice);
  for (const LatticePoint& point : points) sample.positions.push_back(point.position);
  const std::size_t count = points.size();
  sample.masses.assign(count, lattice_mass(body, material, dimensions, count));
  sample.radii.assign(count, body.radius.value_or(body.spacing / 2));
  sample.velocities.assign(count, Vec3::Zero());
  shift_at_random(body, dimensions, sample);
  if (body.kind != BodyKind::deformable) return;
  const LatticeIndex index(lattice, points);
  if (material.bulk_modulus > 0) add_lattice_cells(points, index, dimensions, sample);
  if (material.springs) {
    sample.springs.reserve(springs_per_point(*material.springs) * count);
    add_lattice_springs(points, index, kStructural, material.springs->structural, sample);
    add_lattice_springs(points, index, kShear, material.springs->shear, sample);
    add_lattice_springs(points, index, kBend, material.springs->bend, sample);
  }
}

void take_particles(const ParticleShape& shape, const BodyDescription& body,
                    const Material& material, int dimensions, SampledBody& sample) {
  const std::size_t count = shape.positions.size();
  const Real equal_mass = body.mass ? *body.mass / static_cast<Real>(count)
                                    : point_mass(material.density, body.spacing, dimensions);
  sample.positions = shape.positions;
  sample.velocities = shape.velocities;
  sample.masses = shape.masses;
  sample.radii = shape.radii;
  sample.fixed = shape.fixed;
  if (sample.velocities.empty()) sample.velocities.assign(count, Vec3::Zero());
  if (sample.masses.empty()) sample.masses.assign(count, equal_mass);
  if (sample.radii.empty()) sample.radii.assign(count, body.radius.value_or(body.spacing / 2));
  shift_at_random(body, dimensions, sample);
}

void add_listed_springs(const BodyDescription& body, SampledBody& sample) {
  for (const SpringDescription& spring : body.springs) {
    const Real distance = (sample.positions[spring.a] - sample.positions[spring.b]).norm();
    VAT_CHECK(spring.a < sample.positions.size() && spring.b < sample.positions.size());
    sample.springs.push_back({spring.a, spring.b, spring.constants.stiffness,
                              spring.constants.damping, spring.rest_length.value_or(distance)});
  }
}

Vec3 center_of_mass(const SampledBody& sample) {
  Vec3 moment = Vec3::Zero();
  Real mass = 0;
  for (std::size_t i = 0; i < sample.positions.size(); ++i) {
    moment += sample.masses[i] * sample.positions[i];
    mass += sample.masses[i];
  }
  return moment / mass;
}

void place(const BodyDescription& body, SampledBody& sample) {
  const Mat3 rotation = body.orientation.normalized().toRotationMatrix();
  for (Vec3& position : sample.positions) {
    position = body.position + rotation * position;
    if (body.displacement_field) position += value_at(*body.displacement_field, position);
  }
  const Vec3 center = center_of_mass(sample);
  for (std::size_t i = 0; i < sample.positions.size(); ++i) {
    const Vec3 turning = body.angular_velocity.cross(sample.positions[i] - center);
    sample.velocities[i] = rotation * sample.velocities[i] + body.velocity + turning;
    if (body.velocity_field) {
      sample.velocities[i] += value_at(*body.velocity_field, sample.positions[i]);
    }
  }
  for (const Index fixed : sample.fixed) sample.velocities[fixed].setZero();
}

Real volume_of(const BoxShape& box) {
  return box.size.prod();
}
Real volume_of(const SphereShape& sphere) {
  return 4 * std::numbers::pi / 3 * sphere.radius * sphere.radius * sphere.radius;
}
Real volume_of(const CylinderShape& cylinder) {
  return std::numbers::pi * cylinder.radius * cylinder.radius * cylinder.height;
}
Real volume_of(const MeshShape& mesh) {
  return mesh_volume(mesh);
}
Real volume_of(const ParticleShape&) {
  return 0;
}

Real area_of(const BoxShape& box) {
  return box.size.x() * box.size.z();
}
Real area_of(const SphereShape& sphere) {
  return std::numbers::pi * sphere.radius * sphere.radius;
}
template <class Other>
Real area_of(const Other&) {
  return 0;
}

}  // namespace

SampledBody sample_body(const BodyDescription& body, const Material& material, int dimensions) {
  SampledBody sample;
  if (const auto* particles = std::get_if<ParticleShape>(&body.shape)) {
    take_particles(*particles, body, material, dimensions, sample);
  } else {
    sample_lattice(body, material, dimensions, sample);
  }
  add_listed_springs(body, sample);
  place(body, sample);
  const std::size_t count = sample.positions.size();
  VAT_CHECK(sample.velocities.size() == count && sample.masses.size() == count &&
            sample.radii.size() == count);
  return sample;
}

std::size_t springs_per_point(const LatticeSprings& springs) {
  return (springs.structural ? kStructural.size() : 0) + (springs.shear ? kShear.size() : 0) +
         (springs.bend ? kBend.size() : 0);
}

std::vector<SampledBody> sample_bodies(const Scene& scene) {
  std::vector<SampledBody> samples;
  for (const BodyDescription& body : scene.bodies) {
    samples.push_back(sample_body(body, material_of(scene, body), scene.dimensions));
  }
  return samples;
}

std::vector<const SampledBody*> pointers_to(const std::vector<SampledBody>& bodies) {
  std::vector<const SampledBody*> pointers;
  pointers.reserve(bodies.size());
  for (const SampledBody& body : bodies) pointers.push_back(&body);
  return pointers;
}

Real shape_volume(const Shape& shape) {
  return std::visit([](const auto& s) { return volume_of(s); }, shape);
}

Real shape_area(const Shape& shape) {
  return std::visit([](const auto& s) { return area_of(s); }, shape);
}

}  // namespace vat
