#include "server/output/mesh/shape_mesh.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

namespace vat {

namespace {

constexpr Index kSides = 32;  // of a full circle
constexpr Index kRings = 15;  // of a sphere, between the poles

SurfaceMesh surface(const BoxShape& box) {
  SurfaceMesh mesh;
  for (const int corner : {0, 1, 2, 3, 4, 5, 6, 7}) {  // x in bit 0, y in bit 1, z in bit 2
    const Vec3 sign((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                    (corner & 4) != 0 ? 1 : -1);
    mesh.vertices.push_back(box.center + sign.cwiseProduct(box.size) / 2);
  }
  constexpr std::array<std::array<Index, 4>, 6> kFaces = {
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& [a, b, c, d] : kFaces) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  return mesh;
}

/// Adds the triangles between two circles of vertices, whose first indices are given.
void connect_circles(Index lower, Index upper, SurfaceMesh& mesh) {
  for (Index side = 0; side < kSides; ++side) {
    const Index next = (side + 1) % kSides;
    mesh.triangles.push_back({lower + side, lower + next, upper + next});
    mesh.triangles.push_back({lower + side, upper + next, upper + side});
  }
}

/// Adds the triangles between a circle and a vertex above it, or below it.
void connect_tip(Index circle, Index tip, bool is_above, SurfaceMesh& mesh) {
  for (Index side = 0; side < kSides; ++side) {
    Index first = circle + side;
    Index second = circle + (side + 1) % kSides;
    if (!is_above) std::swap(first, second);
    mesh.triangles.push_back({first, second, tip});
  }
}

/// Adds a circle about the z axis.
void add_circle(Real radius, Real z, SurfaceMesh& mesh) {
  for (Index side = 0; side < kSides; ++side) {
    const Real angle = 2 * std::numbers::pi * side / kSides;
    mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
}

SurfaceMesh surface(const SphereShape& sphere) {
  SurfaceMesh mesh;
  mesh.vertices.emplace_back(0, 0, -sphere.radius);
  mesh.vertices.emplace_back(0, 0, sphere.radius);
  for (Index ring = 1; ring <= kRings; ++ring) {
    const Real angle = std::numbers::pi * ring / (kRings + 1);
    add_circle(sphere.radius * std::sin(angle), -sphere.radius * std::cos(angle), mesh);
  }
  connect_tip(2, 0, false, mesh);
  for (Index ring = 1; ring < kRings; ++ring) {
    connect_circles(2 + (ring - 1) * kSides, 2 + ring * kSides, mesh);
  }
  connect_tip(2 + (kRings - 1) * kSides, 1, true, mesh);
  for (Vec3& vertex : mesh.vertices) vertex += sphere.center;
  return mesh;
}

SurfaceMesh surface(const CylinderShape& cylinder) {
  SurfaceMesh mesh;
  const Real half = cylinder.height / 2;
  mesh.vertices.emplace_back(0, 0, -half);
  mesh.vertices.emplace_back(0, 0, half);
  add_circle(cylinder.radius, -half, mesh);
  add_circle(cylinder.radius, half, mesh);
  connect_tip(2, 0, false, mesh);
  connect_circles(2, 2 + kSides, mesh);
  connect_tip(2 + kSides, 1, true, mesh);
  const Vec3 z = cylinder.axis.normalized();
  const Vec3 x = z.unitOrthogonal();
  const Vec3 y = z.cross(x);
  for (Vec3& vertex : mesh.vertices) {
    vertex = cylinder.center + vertex.x() * x + vertex.y() * y + vertex.z() * z;
  }
  return mesh;
}

SurfaceMesh surface(const MeshShape& shape) {
  return {shape.vertices, shape.triangles};
}

SurfaceMesh surface(const ParticleShape&) {
  return {};
}

}  // namespace

SurfaceMesh surface_of(const Shape& shape) {
  return std::visit([](const auto& each) { return surface(each); }, shape);
}

}  // namespace vat
