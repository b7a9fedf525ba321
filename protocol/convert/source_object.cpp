#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "core/sampling/mesh.h"
#include "protocol/convert/conversion.h"
#include "protocol/scene/mesh_file.h"

namespace vat::conversion {

bool SourceObject::boolean(std::string_view key, bool fallback) {
  const Json* value = member(key);
  if (value != nullptr && value->is_number()) return count(key, 0, 1, 0) == 1;
  return reader_.boolean(key, fallback);
}

Vec3 SourceObject::scale() {
  const Json* value = member("scale");
  if (value != nullptr && value->is_number())
    return Vec3::Constant(real("scale", kMinLength, kMaxLength, 1));
  Vec3 scale = Vec3::Ones();
  if (value == nullptr) return scale;
  return to_vector(*value, path_of("scale"), kMinLength, kMaxLength, report_->errors)
      .value_or(scale);
}

void SourceObject::omit(std::initializer_list<const char*> keys, const char* reason) {
  for (const char* key : keys) {
    const bool is_unread = used_.emplace(key).second;
    if (is_unread && has(key)) report_->omit(path_of(key), reason);
  }
}

void SourceObject::omit_rest() {
  if (!value_->is_object()) return;
  for (const auto& [key, value] : value_->items()) {
    if (!used_.contains(key)) report_->omit(path_of(key), "vat does not know this member");
  }
}

Real tidy(Real value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  const Real rounded = std::strtod(text, nullptr);
  return rounded == 0 ? 0 : rounded;  // not -0
}

Json tidy_json(const Vec3& vector, int digits) {
  const Real zero = 1e-14 * vector.norm();  // the rounding errors of rotations
  Json list = Json::array();
  for (const Real value : vector) list.push_back(std::abs(value) < zero ? 0 : tidy(value, digits));
  return list;
}

Placement read_placement(SourceObject& object, const Vec3& default_axis) {
  Placement placement;
  placement.position = z_up(object.vector("translation", kMaxLength, Vec3::Zero()));
  const Vec3 axis = z_up(object.vector("rotationAxis", kMaxLength, default_axis));
  const Real angle = object.real("rotationAngle", -1e3, 1e3, 0);
  if (axis.norm() > 0) placement.orientation = Eigen::AngleAxis<Real>(angle, axis.normalized());
  return placement;
}

void write_placement(const Placement& placement, Json& body) {
  if (!placement.position.isZero()) body["position"] = tidy_json(placement.position);
  const Quat& q = placement.orientation;
  if (q.vec().isZero(1e-15)) return;
  body["orientation"] = {tidy(q.w()), tidy(q.x()), tidy(q.y()), tidy(q.z())};
}

std::optional<MeshShape> read_geometry(Conversion& conversion, const std::string& file,
                                       const std::string& path, const Vec3& scale) {
  if (!file.ends_with(".obj") && !file.ends_with(".ply")) {  // the formats of the source
    add_error(conversion.report.errors, "bad_mesh", path, "must end in .obj or .ply");
    return {};
  }
  const Result<std::string> bytes = (*conversion.meshes)(file);
  Result<MeshShape> mesh = bytes ? read_mesh(bytes.value(), file, 1) : bytes.errors();
  if (!mesh) {
    for (const Error& error : mesh.errors()) {
      add_error(conversion.report.errors, error.code, path, error.message);
    }
    return {};
  }
  MeshShape& shape = mesh.value();
  for (Vec3& vertex : shape.vertices) vertex = z_up(vertex.cwiseProduct(scale));
  if (mesh_volume(shape) < 0) {
    for (auto& triangle : shape.triangles) std::swap(triangle[1], triangle[2]);
  }
  return std::move(shape);
}

std::optional<std::pair<Vec3, Vec3>> box_of(const MeshShape& mesh) {
  if (mesh.vertices.empty() || mesh.vertices.size() > 1000) return {};
  Vec3 min = mesh.vertices.front();
  Vec3 max = min;
  for (const Vec3& vertex : mesh.vertices) {
    min = min.cwiseMin(vertex);
    max = max.cwiseMax(vertex);
  }
  const Vec3 size = max - min;
  const Real error = 1e-6 * size.maxCoeff();
  if (!(size.minCoeff() > error)) return {};
  for (const Vec3& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      const Real distance = std::min(vertex[axis] - min[axis], max[axis] - vertex[axis]);
      if (distance > error) return {};
    }
  }
  // A part of the corners, for example a tetrahedron, has less volume.
  if (mesh_volume(mesh) < 0.999 * size.prod()) return {};
  return std::pair(min, max);
}

Json box_json(const Vec3& min, const Vec3& max) {
  Json box = {{"type", "box"}, {"size", tidy_json(max - min)}};
  const Vec3 center = (min + max) / 2;
  if (!center.isZero(1e-12)) box["center"] = tidy_json(center);
  return box;
}

Json shape_json(const MeshShape& mesh) {
  if (const auto box = box_of(mesh)) return box_json(box->first, box->second);
  constexpr int kDigits = 7;  // of single precision, as mesh files have
  Json vertices = Json::array();
  for (const Vec3& vertex : mesh.vertices) vertices.push_back(tidy_json(vertex, kDigits));
  return {{"type", "mesh"},
          {"source", mesh.source},
          {"vertices", std::move(vertices)},
          {"triangles", mesh.triangles}};
}

}  // namespace vat::conversion
