// Parts of the writers.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/sampling/mesh.h"
#include "server/output/crc32.h"
#include "server/output/shape_mesh.h"

namespace vat::test::output_parts_test {
namespace {

TEST(OutputParts, CrcHasItsPublishedCheckValue) {
  constexpr std::string_view kDigits = "123456789";
  EXPECT_EQ(crc32(kDigits), 0xCBF43926U);  // the check value of CRC-32/ISO-HDLC
  for (std::size_t cut = 0; cut <= kDigits.size(); ++cut) {
    EXPECT_EQ(crc32(kDigits.substr(cut), crc32(kDigits.substr(0, cut))), 0xCBF43926U) << cut;
  }
  EXPECT_EQ(crc32(""), 0U);
}

MeshShape mesh_of(const Shape& shape) {
  SurfaceMesh surface = surface_of(shape);
  return {"", surface.vertices, surface.triangles};
}

Vec3 middle_of(const MeshShape& mesh) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& vertex : mesh.vertices) sum += vertex;
  return sum / static_cast<Real>(mesh.vertices.size());
}

TEST(OutputParts, SurfacesAreClosedAndEncloseTheirShape) {
  struct Case {
    Shape shape;
    Real volume;
    Real error;  ///< relative, of the polygons in place of circles
  };
  const Vec3 center(0.5, -0.25, 1);
  const Real pi = std::numbers::pi;
  // A polygon of 32 sides has sin(a)/a of the circle's area, with the angle a = pi/16 of a side. On
  // a sphere, the circles and the meridians are such polygons.
  const Real polygon = 1 - std::sin(pi / 16) / (pi / 16);
  for (const auto& [shape, volume, error] :
       {Case{BoxShape{center, {1, 2, 3}}, 6, 1e-12},
        Case{SphereShape{center, 0.5}, 4 * pi / 3 * 0.125, 3 * polygon},
        Case{CylinderShape{center, {1, 2, -1}, 0.5, 2}, pi * 0.25 * 2, 1.001 * polygon}}) {
    const MeshShape mesh = mesh_of(shape);
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_LE(mesh_volume(mesh), volume * (1 + 1e-12));
    EXPECT_GE(mesh_volume(mesh), volume * (1 - error));
    EXPECT_LT((middle_of(mesh) - center).norm(), 1e-12);
  }
  EXPECT_TRUE(surface_of(ParticleShape{{Vec3::Zero()}, {}, {}, {}, {}}).vertices.empty());
}

TEST(OutputParts, CylinderHasItsAxis) {
  const SurfaceMesh mesh = surface_of(CylinderShape{Vec3::Zero(), {0, -3, 0}, 0.5, 2});
  Vec3 greatest = Vec3::Zero();
  for (const Vec3& vertex : mesh.vertices) greatest = greatest.cwiseMax(vertex.cwiseAbs());
  EXPECT_LT((greatest - Vec3(0.5, 1, 0.5)).norm(), 1e-12);
}

}  // namespace
}  // namespace vat::test::output_parts_test
