#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "server/output/alembic/abc_archive.h"
#include "server/output/bytes.h"
#include "server/output/frame_formats.h"
#include "server/output/mesh/liquid_surface.h"
#include "server/output/mesh/shape_mesh.h"

namespace vat {

namespace {

constexpr const char* kXform = "AbcGeom_Xform_v3";
constexpr const char* kPointsSchema = "AbcGeom_Points_v1";
constexpr const char* kPolyMesh = "AbcGeom_PolyMesh_v1";

std::string floats_of(std::span<const Vec3> vectors) {
  std::string bytes;
  bytes.reserve(vectors.size() * 3 * sizeof(float));
  for (const Vec3& vector : vectors) {
    for (const Real value : vector) append_bytes(bytes, static_cast<float>(value));
  }
  return bytes;
}

std::string bounds_of(std::span<const Vec3> positions) {
  Vec3 min = positions.empty() ? Vec3(Vec3::Zero()) : positions.front();
  Vec3 max = min;
  for (const Vec3& position : positions) {
    min = min.cwiseMin(position);
    max = max.cwiseMax(position);
  }
  std::string bytes;
  for (const Real value : min) append_bytes(bytes, value);
  for (const Real value : max) append_bytes(bytes, value);
  return bytes;
}

/// Returns the matrix of the format, which multiplies rows from the right.
std::string matrix_of(const Mat3& rotation, const Vec3& translation) {
  std::string bytes;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) append_bytes(bytes, rotation(column, row));
    append_bytes(bytes, Real{0});
  }
  for (const Real value : translation) append_bytes(bytes, value);
  append_bytes(bytes, Real{1});
  return bytes;
}

AbcProperty bounds_property(bool is_timed) {
  return {".selfBnds", "interpretation=box", AbcType::float64, 6, false, is_timed};
}

/// Indices of the properties in an object of points or of a mesh.
enum Property : std::size_t { kBounds, kPositions };
enum PointsProperty : std::size_t { kIds = 2, kVelocities, kWidths };
enum MeshProperty : std::size_t { kFaceIndices = 2, kFaceCounts };

/// Writes particles as points with velocities and ids, rigid bodies as transformations with a mesh,
/// and surfaces of liquids as meshes.
class AbcWriter final : public FrameWriter {
 public:
  AbcWriter(OgawaFile file, bool has_surfaces)
      : archive_(std::move(file)), has_surfaces_(has_surfaces) {}
  ~AbcWriter() override {
    // The run has already reported its error.
    if (!is_complete_ && !archive_.times.empty()) static_cast<void>(archive_.complete());
  }

  Status write(const Simulation& simulation) override {
    const std::vector<BodyView> bodies = simulation.bodies();
    if (archive_.times.empty()) start(simulation, bodies);
    archive_.times.push_back(simulation.time());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (bodies[i].kind == BodyKind::rigid) {
        add_pose(*objects_[i], *bodies[i].pose);
      } else {
        add_points(*objects_[i], bodies[i]);
      }
    }
    for (const auto& [material, object] : surfaces_) {
      add_surface(*object, liquid_surface(bodies, material));
    }
    return archive_.status();
  }

  Status finish() override {
    is_complete_ = true;
    if (Status completed = archive_.complete(); !completed) return completed;
    return archive_.commit();
  }

 private:
  /// Adds the objects with their constant properties. The root object turns the z axis upwards.
  void start(const Simulation& simulation, const std::vector<BodyView>& bodies) {
    AbcObject& root = archive_.objects.emplace_back();
    make_xform(root, "vat", false);
    Mat3 turn;
    turn << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    archive_.add_sample(root.properties[2], matrix_of(turn, Vec3::Zero()));
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      AbcObject& object = root.children.emplace_back();
      objects_.push_back(&object);
      const std::string name = unique_name(bodies[i].name);
      if (bodies[i].kind != BodyKind::rigid) {
        make_points(object, name, bodies[i].radii, true);
        continue;
      }
      make_xform(object, name, true);
      add_shape(object, bodies[i], simulation.scene().bodies[i].shape);
    }
    if (has_surfaces_) start_surfaces(root, bodies);
  }

  void start_surfaces(AbcObject& root, const std::vector<BodyView>& bodies) {
    for (const BodyView& body : bodies) {
      if (body.kind != BodyKind::liquid || surfaces_.contains(body.material)) continue;
      AbcObject& object = root.children.emplace_back();
      make_mesh(object, unique_name(std::string(body.material) + " surface"), true);
      surfaces_.emplace(body.material, &object);
    }
  }

  /// Returns the name without the character that separates objects, different from earlier names.
  std::string unique_name(std::string_view name) {
    std::string unique(name);
    std::ranges::replace(unique, '/', '_');
    while (!names_.insert(unique).second) unique += '_';
    return unique;
  }

  void make_xform(AbcObject& object, const std::string& name, bool is_timed) {
    object.name = name;
    object.schema = kXform;
    object.compound = ".xform";
    const std::string yes(1, '\1');
    const std::string matrix(1, '\x30');  // operation 3, without a hint
    add_constant(object, {".inherits", "", AbcType::boolean, 1, false, is_timed}, yes);
    add_constant(object, {".ops", "", AbcType::uint8, 1, false, false}, matrix);
    object.properties.push_back({".vals", "", AbcType::float64, 16, false, is_timed});
    add_constant(object, {"isNotConstantIdentity", "", AbcType::boolean, 1, false, false}, yes);
  }

  void add_constant(AbcObject& object, AbcProperty property, std::string_view bytes) {
    object.properties.push_back(std::move(property));
    archive_.add_sample(object.properties.back(), bytes);
  }

  void make_points(AbcObject& object, const std::string& name, std::span<const Real> radii,
                   bool is_timed) {
    object.name = name;
    object.schema = kPointsSchema;
    object.compound = ".geom";
    object.properties.push_back(bounds_property(is_timed));
    object.properties.push_back(
        {"P", "geoScope=var;interpretation=point", AbcType::float32, 3, true, is_timed});
    object.properties.push_back({".pointIds", "geoScope=var", AbcType::uint64, 1, true, is_timed});
    object.properties.push_back(
        {".velocities", "interpretation=vector", AbcType::float32, 3, true, is_timed});
    const bool is_uniform = std::ranges::adjacent_find(radii, std::not_equal_to<>()) == radii.end();
    if (!is_uniform || radii.empty()) return;
    std::string width;
    append_bytes(width, static_cast<float>(2 * radii.front()));
    add_constant(
        object,
        {".widths", "arrayExtent=1;geoScope=con;isGeomParam=true;podExtent=1;podName=float32_t",
         AbcType::float32, 1, true, false},
        width);
  }

  void add_shape(AbcObject& object, const BodyView& body, const Shape& shape) {
    AbcObject& child = object.children.emplace_back();
    SurfaceMesh surface = surface_of(shape);
    if (surface.vertices.empty()) {
      make_points(child, "particles", body.radii, false);
      add_positions(child, body.local_positions);
      add_ids(child, body);
      child.properties.erase(child.properties.begin() + kVelocities);
      return;
    }
    for (Vec3& vertex : surface.vertices) vertex += body.shape_origin;
    make_mesh(child, "shape", false);
    add_surface(child, surface);
  }

  static void make_mesh(AbcObject& object, const std::string& name, bool is_timed) {
    object.name = name;
    object.schema = kPolyMesh;
    object.compound = ".geom";
    object.properties.push_back(bounds_property(is_timed));
    object.properties.push_back(
        {"P", "geoScope=vtx;interpretation=point", AbcType::float32, 3, true, is_timed});
    object.properties.push_back({".faceIndices", "", AbcType::int32, 1, true, is_timed});
    object.properties.push_back({".faceCounts", "", AbcType::int32, 1, true, is_timed});
  }

  void add_surface(AbcObject& object, const SurfaceMesh& surface) {
    add_positions(object, surface.vertices);
    std::string indices;
    std::string counts;
    for (const auto& [a, b, c] : surface.triangles) {
      for (const Index corner : {c, b, a}) {  // clockwise, as the format defines
        append_bytes(indices, static_cast<std::int32_t>(corner));
      }
      append_bytes(counts, std::int32_t{3});
    }
    archive_.add_sample(object.properties[kFaceIndices], indices);
    archive_.add_sample(object.properties[kFaceCounts], counts);
  }

  void add_pose(AbcObject& object, const RigidPose& pose) {
    archive_.add_sample(object.properties[2],
                        matrix_of(pose.orientation.toRotationMatrix(), pose.center_of_mass));
  }

  void add_positions(AbcObject& object, std::span<const Vec3> positions) {
    archive_.add_sample(object.properties[kBounds], bounds_of(positions));
    archive_.add_sample(object.properties[kPositions], floats_of(positions));
  }

  void add_ids(AbcObject& object, const BodyView& body) {
    AbcProperty& ids = object.properties[kIds];
    const std::size_t bytes = body.positions.size() * sizeof(std::uint64_t);
    // Without a list, the numbers are the indices.
    const bool is_same = body.numbers.empty() && !ids.samples.empty() && ids.sizes.back() == bytes;
    if (is_same) return archive_.repeat_sample(ids);
    std::string numbers;
    for (std::size_t i = 0; i < body.positions.size(); ++i) {
      append_bytes(numbers, std::uint64_t{body.numbers.empty() ? i : body.numbers[i]});
    }
    archive_.add_sample(ids, numbers);
  }

  void add_points(AbcObject& object, const BodyView& body) {
    add_positions(object, body.positions);
    add_ids(object, body);
    archive_.add_sample(object.properties[kVelocities], floats_of(body.velocities));
  }

  AbcArchive archive_;
  std::vector<AbcObject*> objects_;                          ///< by the indices of the bodies
  std::map<std::string, AbcObject*, std::less<>> surfaces_;  ///< by the names of materials
  std::set<std::string> names_;
  bool has_surfaces_;
  bool is_complete_ = false;
};

}  // namespace

Result<std::unique_ptr<FrameWriter>> create_abc_writer(const std::string& name,
                                                       bool has_liquid_surfaces) {
  Result<OgawaFile> file = OgawaFile::create(name);
  if (!file) return file.errors();
  return std::unique_ptr<FrameWriter>(
      std::make_unique<AbcWriter>(std::move(file).value(), has_liquid_surfaces));
}

}  // namespace vat
