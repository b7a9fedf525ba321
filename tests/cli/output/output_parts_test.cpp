// Parts of the writers.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/sampling/mesh.h"
#include "server/output/crc32.h"
#include "server/output/mesh/liquid_surface.h"
#include "server/output/mesh/shape_mesh.h"

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

/// Cubic lattice with the given number of particles per axis and the spacing 1, whose cells begin
/// at `min`.
std::vector<Vec3> lattice(const Vec3& min, const std::array<int, 3>& counts) {
  std::vector<Vec3> positions;
  for (int x = 0; x < counts[0]; ++x) {
    for (int y = 0; y < counts[1]; ++y) {
      for (int z = 0; z < counts[2]; ++z) positions.emplace_back(min + Vec3(x, y, z));
    }
  }
  for (Vec3& position : positions) position.array() += 0.5;
  return positions;
}

MeshShape liquid_mesh(const std::vector<Vec3>& positions) {
  const std::vector<Real> radii(positions.size(), 0.5);
  SurfaceMesh surface = liquid_surface(positions, radii);
  return {"", surface.vertices, surface.triangles};
}

// The sides may deviate by a tenth of the grid's cell. The edges are rounded within one spacing. A
// rounded edge of length 1 lacks (1 - pi / 4) times the square of its radius.
TEST(OutputParts, LiquidSurfaceEnclosesTheCellsOfTheParticles) {
  const Vec3 min(-7.3, -3.1, 2.6);
  const std::array<int, 3> counts = {20, 9, 5};
  const MeshShape mesh = liquid_mesh(lattice(min, counts));
  EXPECT_TRUE(is_closed(mesh));
  Vec3 least = mesh.vertices.front();
  Vec3 greatest = least;
  for (const Vec3& vertex : mesh.vertices) {
    least = least.cwiseMin(vertex);
    greatest = greatest.cwiseMax(vertex);
  }
  const Vec3 size(counts[0], counts[1], counts[2]);
  EXPECT_LT((least - min).cwiseAbs().maxCoeff(), 0.05);
  EXPECT_LT((greatest - min - size).cwiseAbs().maxCoeff(), 0.05);
  const Real round = (1 - std::numbers::pi / 4) * 4 * size.sum();
  EXPECT_LT(mesh_volume(mesh), size.prod() + 0.05 * 2 * (180 + 100 + 45));
  EXPECT_GT(mesh_volume(mesh), size.prod() - 0.05 * 2 * (180 + 100 + 45) - round);
}

TEST(OutputParts, LiquidSurfacesAreSeparateAcrossAGap) {
  std::vector<Vec3> positions = lattice({0, 0, 0}, {12, 12, 4});
  const std::vector<Vec3> upper = lattice({0, 0, 6}, {12, 12, 4});
  positions.insert(positions.end(), upper.begin(), upper.end());
  const MeshShape mesh = liquid_mesh(positions);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_TRUE(std::ranges::none_of(
      mesh.vertices, [](const Vec3& vertex) { return vertex.z() > 4.25 && vertex.z() < 5.75; }));
}

TEST(OutputParts, IsolatedParticlesHaveARoundSurface) {
  const Vec3 center(0.2, -17.4, 3.9);
  const MeshShape mesh = liquid_mesh({center, {40, 0, 0}});
  EXPECT_TRUE(is_closed(mesh));
  std::size_t own = 0;
  for (const Vec3& vertex : mesh.vertices) {
    if ((vertex - center).norm() > 2) continue;
    ++own;
    EXPECT_NEAR((vertex - center).norm(), 0.64, 0.25);  // half a cell of the grid
  }
  EXPECT_GE(own, 8u);
  EXPECT_TRUE(liquid_mesh({}).vertices.empty());
}

}  // namespace
}  // namespace vat::test::output_parts_test
