#include "core/limits.h"
#include "protocol/scene/mesh_file.h"
#include "protocol/scene/scene_parts.h"

namespace vat::scene_parts {
namespace {

using Vectors = std::vector<Vec3>;

Vectors to_vectors(const Json& list, const std::string& path, Real bound, Errors& errors) {
  Vectors vectors;
  vectors.reserve(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto vector = to_vector(list[i], pointer_to(path, i), -bound, bound, errors);
    vectors.push_back(vector.value_or(Vec3::Zero()));
  }
  return vectors;
}

}  // namespace

std::vector<Vec3> read_vectors(ObjectReader& reader, std::string_view key, Real bound,
                               bool required, Errors& errors) {
  const Json* list = reader.array(key, kMaxParticles, required);
  if (list == nullptr) return {};
  return to_vectors(*list, reader.path_of(key), bound, errors);
}

Quat to_orientation(const Json& value, const std::string& path, Errors& errors) {
  if (to_array(value, path, 4, 4, errors) == nullptr) return Quat::Identity();
  std::array<Real, 4> components{};
  for (std::size_t i = 0; i < 4; ++i) {
    components[i] = to_real(value[i], pointer_to(path, i), kAnyMin, kAnyMax, errors).value_or(0);
  }
  return {components[0], components[1], components[2], components[3]};
}

namespace {

std::vector<Real> read_reals(ObjectReader& reader, std::string_view key, Real min, Real max,
                             Errors& errors) {
  std::vector<Real> reals;
  const Json* list = reader.array(key, kMaxParticles);
  if (list == nullptr) return reals;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const auto real = to_real((*list)[i], pointer_to(reader.path_of(key), i), min, max, errors);
    reals.push_back(real.value_or(min));
  }
  return reals;
}

/// Reads the elements of `list` as indices of particles or vertices.
std::vector<Index> to_indices(const Json& list, const std::string& path, Errors& errors) {
  std::vector<Index> indices;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto index = to_count(list[i], pointer_to(path, i), 0, kMaxParticles - 1, errors);
    indices.push_back(static_cast<Index>(index.value_or(0)));
  }
  return indices;
}

BoxShape read_box(ObjectReader& reader) {
  BoxShape box;
  box.center = reader.vector("center", -kMaxLength, kMaxLength, box.center);
  box.size = reader.vector("size", kMinLength, kMaxLength);
  return box;
}

SphereShape read_sphere(ObjectReader& reader) {
  SphereShape sphere;
  sphere.center = reader.vector("center", -kMaxLength, kMaxLength, sphere.center);
  sphere.radius = reader.real("radius", kMinLength, kMaxLength);
  return sphere;
}

CylinderShape read_cylinder(ObjectReader& reader) {
  CylinderShape cylinder;
  cylinder.center = reader.vector("center", -kMaxLength, kMaxLength, cylinder.center);
  cylinder.axis = reader.vector("axis", -kMaxLength, kMaxLength, cylinder.axis);
  cylinder.radius = reader.real("radius", kMinLength, kMaxLength);
  cylinder.height = reader.real("height", kMinLength, kMaxLength);
  return cylinder;
}

MeshShape read_mesh_file(ObjectReader& reader, const MeshSource& meshes, Errors& errors) {
  MeshShape mesh;
  const std::size_t errors_before = errors.size();
  const std::string file = reader.text("file", kMaxFileName);
  const Real scale = reader.real("scale", kMinLength, kMaxLength, 1);
  if (errors.size() != errors_before) return mesh;
  const auto report = [&](const Errors& found) {
    for (const Error& error : found) {
      add_error(errors, error.code, reader.path_of("file"), error.message);
    }
  };
  const Result<std::string> bytes = meshes(file);
  if (!bytes) {
    report(bytes.errors());
    return mesh;
  }
  Result<MeshShape> read = read_mesh(bytes.value(), file, scale, meshes);
  if (!read) {
    report(read.errors());
    return mesh;
  }
  return std::move(read).value();
}

MeshShape read_inline_mesh(ObjectReader& reader, Errors& errors) {
  MeshShape mesh;
  mesh.source = reader.text("source", kMaxFileName, "");
  mesh.vertices = read_vectors(reader, "vertices", kMaxLength, true, errors);
  const Json* triangles = reader.array("triangles", kMaxMeshTriangles, true);
  if (triangles == nullptr) return mesh;
  for (std::size_t i = 0; i < triangles->size(); ++i) {
    const std::string path = pointer_to(reader.path_of("triangles"), i);
    if (to_array((*triangles)[i], path, 3, 3, errors) == nullptr) continue;
    const std::vector<Index> corners = to_indices((*triangles)[i], path, errors);
    mesh.triangles.push_back({corners[0], corners[1], corners[2]});
  }
  return mesh;
}

ParticleShape read_particles(ObjectReader& reader, Errors& errors) {
  ParticleShape particles;
  particles.positions = read_vectors(reader, "positions", kMaxLength, true, errors);
  particles.velocities = read_vectors(reader, "velocities", kMaxSpeed, false, errors);
  particles.masses = read_reals(reader, "masses", kMinMass, kMaxMass, errors);
  particles.radii = read_reals(reader, "radii", kMinLength, kMaxLength, errors);
  if (const Json* fixed = reader.array("fixed", kMaxParticles)) {
    particles.fixed = to_indices(*fixed, reader.path_of("fixed"), errors);
  }
  return particles;
}

SpringDescription to_spring(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  SpringDescription spring;
  if (const Json* ends = reader.member("particles", true)) {
    if (to_array(*ends, reader.path_of("particles"), 2, 2, errors) != nullptr) {
      const std::vector<Index> indices = to_indices(*ends, reader.path_of("particles"), errors);
      spring.a = indices[0];
      spring.b = indices[1];
    }
  }
  spring.constants = to_spring_constants(reader);
  if (reader.has("rest_length")) spring.rest_length = reader.real("rest_length", 0, kMaxLength);
  reader.refuse_unknown();
  return spring;
}

Mat3 to_matrix(const Json& value, const std::string& path, Real bound, Errors& errors) {
  Mat3 matrix = Mat3::Zero();
  if (to_array(value, path, 3, 3, errors) == nullptr) return matrix;
  const Vectors rows = to_vectors(value, path, bound, errors);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    matrix.row(static_cast<Eigen::Index>(row)) = rows[row].transpose();
  }
  return matrix;
}

PlaneWave to_wave(const Json& value, std::string path, Real bound, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  PlaneWave wave;
  wave.amplitude = reader.vector("amplitude", -bound, bound);
  wave.wave_vector = reader.vector("wave_vector", -kMaxWaveNumber, kMaxWaveNumber);
  wave.phase = reader.real("phase", -kMaxPhase, kMaxPhase, wave.phase);
  reader.refuse_unknown();
  return wave;
}

void read_field(ObjectReader& reader, std::string_view key, Real bound,
                std::optional<VectorField>& field, Errors& errors) {
  if (const Json* value = reader.member(key)) {
    field = to_field(*value, reader.path_of(key), bound, errors);
  }
}

Melting to_melting(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  Melting melting;
  melting.into = reader.text("into", kMaxNameLength);
  melting.at = reader.real("at", 0, kMaxRelease);
  reader.refuse_unknown();
  return melting;
}

Axle to_axle(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  Axle axle;
  axle.direction = reader.vector("direction", -kMaxLength, kMaxLength, axle.direction);
  axle.damping = reader.real("damping", 0, kMaxDamping, axle.damping);
  reader.refuse_unknown();
  return axle;
}

void read_placement(ObjectReader& reader, BodyDescription& body, Errors& errors) {
  body.position = reader.vector("position", -kMaxLength, kMaxLength, body.position);
  read_member(reader, "orientation", body.orientation, errors, to_orientation);
  body.velocity = reader.vector("velocity", -kMaxSpeed, kMaxSpeed, body.velocity);
  body.angular_velocity =
      reader.vector("angular_velocity", kAnyMin, kAnyMax, body.angular_velocity);
  read_field(reader, "velocity_field", kMaxSpeed, body.velocity_field, errors);
  read_field(reader, "displacement_field", kMaxLength, body.displacement_field, errors);
  body.jitter = reader.real("jitter", 0, kMaxJitter, body.jitter);
  body.seed = static_cast<std::uint32_t>(
      reader.count("seed", 0, std::numeric_limits<std::uint32_t>::max(), body.seed));
  body.fixed = reader.boolean("fixed", body.fixed);
  body.release = reader.real("release", 0, kMaxRelease, body.release);
  read_member(reader, "melting", body.melting, errors, to_melting);
  read_member(reader, "motion", body.motion, errors, to_motion);
  read_member(reader, "axle", body.axle, errors, to_axle);
  body.sub_steps =
      static_cast<std::uint32_t>(reader.count("sub_steps", 1, kMaxSubSteps, body.sub_steps));
}

}  // namespace

Shape to_shape(const Json& value, const std::string& path, const MeshSource& meshes,
               Errors& errors) {
  ObjectReader reader(value, path, errors);
  const std::size_t errors_before = errors.size();
  const std::size_t type =
      reader.choice("type", {"box", "sphere", "cylinder", "mesh", "particles"});
  if (errors.size() != errors_before || !value.is_object())
    return {};  // further errors would follow from these
  Shape shape;
  switch (type) {
    case 0:
      shape = read_box(reader);
      break;
    case 1:
      shape = read_sphere(reader);
      break;
    case 2:
      shape = read_cylinder(reader);
      break;
    case 3:
      shape = reader.has("vertices") || reader.has("triangles")
                  ? Shape(read_inline_mesh(reader, errors))
                  : Shape(read_mesh_file(reader, meshes, errors));
      break;
    default:
      shape = read_particles(reader, errors);
      break;
  }
  reader.refuse_unknown();
  return shape;
}

VectorField to_field(const Json& value, std::string path, Real bound, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  VectorField field;
  field.center = reader.vector("center", -kMaxLength, kMaxLength, field.center);
  if (const Json* gradient = reader.member("gradient")) {
    field.gradient = to_matrix(*gradient, reader.path_of("gradient"), kMaxGradient, errors);
  }
  if (const Json* waves = reader.array("waves", kMaxWaves)) {
    for (std::size_t i = 0; i < waves->size(); ++i) {
      field.waves.push_back(
          to_wave((*waves)[i], pointer_to(reader.path_of("waves"), i), bound, errors));
    }
  }
  reader.refuse_unknown();
  return field;
}

BodyDescription to_body(const Json& value, const std::string& path, const MeshSource& meshes,
                        Errors& errors) {
  ObjectReader reader(value, path, errors);
  BodyDescription body;
  body.name = reader.text("name", kMaxNameLength);
  body.kind = read_enum<BodyKind>(reader, "kind");
  body.material = reader.text("material", kMaxNameLength);
  if (const Json* shape = reader.member("shape", true)) {
    body.shape = to_shape(*shape, reader.path_of("shape"), meshes, errors);
  }
  if (reader.has("spacing") || !std::holds_alternative<ParticleShape>(body.shape)) {
    body.spacing = reader.real("spacing", kMinLength, kMaxLength);
  }
  if (reader.has("mass")) body.mass = reader.real("mass", kMinMass, kMaxMass);
  if (reader.has("radius")) body.radius = reader.real("radius", kMinLength, kMaxLength);
  read_placement(reader, body, errors);
  if (const Json* springs = reader.array("springs", kMaxSprings)) {
    for (std::size_t i = 0; i < springs->size(); ++i) {
      body.springs.push_back(
          to_spring((*springs)[i], pointer_to(reader.path_of("springs"), i), errors));
    }
  }
  reader.refuse_unknown();
  return body;
}

}  // namespace vat::scene_parts
