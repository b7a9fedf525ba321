#include "core/sampling/mesh.h"

#include <gtest/gtest.h>

#include <random>

#include "core/sampling/lattice.h"
#include "core/validation/validate_parts.h"
#include "tests/core/sampling/mesh_shapes.h"

namespace vat::mesh_test {
namespace {

/// An octahedron with the faces |x| + |y| + |z| = 1.
MeshShape octahedron() {
  MeshShape mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

TEST(Mesh, HasTheVolumeOfItsSolid) {
  EXPECT_DOUBLE_EQ(mesh_volume(box_mesh({-1, 2, 3}, {1, 5, 4})), 2 * 3 * 1);
  EXPECT_NEAR(mesh_volume(octahedron()), 4.0 / 3, 1e-15);
  EXPECT_DOUBLE_EQ(mesh_volume(inside_out(box_mesh({0, 0, 0}, {1, 1, 1}))), -1);
  const Vec3 far = Vec3::Constant(1e5);
  EXPECT_NEAR(mesh_volume(box_mesh(far, far + Vec3::Constant(0.125))), 0.001953125, 1e-15);
}

TEST(Mesh, IsClosedWithoutAnyGapOrTurnedTriangle) {
  MeshShape box = box_mesh({0, 0, 0}, {1, 1, 1});
  EXPECT_TRUE(is_closed(box));
  EXPECT_FALSE(is_closed(MeshShape{}));
  std::swap(box.triangles[4][0], box.triangles[4][1]);
  EXPECT_FALSE(is_closed(box));
  box = box_mesh({0, 0, 0}, {1, 1, 1});
  box.triangles.pop_back();
  EXPECT_FALSE(is_closed(box));
}

TEST(Mesh, IsClosedWithRepeatedVertices) {
  const MeshShape box = box_mesh({0, 0, 0}, {1, 1, 1});
  MeshShape loose;
  for (const auto& triangle : box.triangles) {
    const auto first = static_cast<Index>(loose.vertices.size());
    for (const Index corner : triangle) loose.vertices.push_back(box.vertices[corner]);
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_TRUE(is_closed(loose));
}

/// Returns the lattice points in `mesh`. Its bounding box must be a whole number of cells per side.
std::vector<LatticePoint> fill(const MeshShape& mesh, Real spacing) {
  const Lattice lattice = make_lattice(mesh, spacing);
  EXPECT_EQ(Allowance().take_lattice(mesh, lattice), nullptr);
  return fill_lattice(mesh, lattice);
}

TEST(Mesh, IsFilledLikeTheSolidThatItBounds) {
  const std::vector<LatticePoint> points = fill(octahedron(), 0.02);
  std::size_t expected = 0;
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 100; ++j) {
      for (int k = 0; k < 100; ++k) {
        const Vec3 p = Vec3(i, j, k) * 0.02 + Vec3::Constant(0.01 - 1);
        if (p.cwiseAbs().sum() < 1 - 1e-9) ++expected;  // no point is on a face: the sum is odd
      }
    }
  }
  EXPECT_EQ(points.size(), expected);
  for (const LatticePoint& point : points) EXPECT_LT(point.position.cwiseAbs().sum(), 1);
}

// The lattice lines pass exactly through edges, diagonals and corners of these boxes.
TEST(Mesh, IsFilledAtEdgesAndCorners) {
  const MeshShape mesh =
      joined(box_mesh({0, 0, 0}, {3, 3, 1}), box_mesh({0.5, 0.5, 1}, {1.5, 1.5, 3}));
  const std::vector<LatticePoint> points = fill(mesh, 1);
  // A 3 x 3 slab, and a 1 x 1 tower with one line through (0.5, 0.5): on its lower corner, or on
  // none of its four edges, but never on two.
  EXPECT_EQ(points.size(), 9u + 2u);
}

TEST(Mesh, OfTwoSolidsThatOverlapIsTheirUnion) {
  const MeshShape mesh = joined(box_mesh({0, 0, 0}, {2, 1, 1}), box_mesh({1, 0, 0}, {3, 1, 1}));
  EXPECT_EQ(fill(mesh, 0.1).size(), 30u * 10u * 10u);
}

TEST(Mesh, WithACavityIsHollow) {
  const MeshShape mesh = joined(box_mesh({0, 0, 0}, {1, 1, 1}),
                                inside_out(box_mesh({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8})));
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(mesh_volume(mesh), 1 - 0.216, 1e-15);
  EXPECT_EQ(fill(mesh, 0.1).size(), 1000u - 216u);
}

TEST(Mesh, CrossingsOfALineCancelOut) {
  std::mt19937 random(7);
  std::uniform_real_distribution<Real> coordinate(-1, 1);
  MeshShape mesh = octahedron();
  for (Vec3& vertex : mesh.vertices) {
    vertex += 0.3 * Vec3(coordinate(random), coordinate(random), coordinate(random));
  }
  const MeshLines lines{{-1.5, -1.5, 0}, 0.01, {300, 300}};
  const std::vector<MeshCrossing> crossings = find_crossings(mesh, lines);
  ASSERT_GT(crossings.size(), 20'000u);
  int turns = 0;
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    turns += crossings[i].turn;
    const bool last = i + 1 == crossings.size() || crossings[i + 1].line != crossings[i].line;
    if (last) {
      ASSERT_EQ(turns, 0) << "line " << crossings[i].line;
    }
  }
}

TEST(Mesh, TooMuchWorkIsRefusedBeforeItIsDone) {
  MeshShape mesh = box_mesh({0, 0, 0}, {1, 1, 0.001});
  for (int i = 0; i < 20; ++i) mesh = joined(mesh, box_mesh({0, 0, 0}, {1, 1, 0.001}));
  const Lattice fine = make_lattice(mesh, 0.001);
  EXPECT_NE(Allowance().take_lattice(mesh, fine), nullptr);
  EXPECT_EQ(Allowance().take_lattice(mesh, make_lattice(mesh, 0.01)), nullptr);
  // A seventh of the limit passes, and twice that fails.
  MeshShape part = mesh;
  part.triangles.resize(mesh.triangles.size() / 7);
  Allowance allowance;
  EXPECT_EQ(allowance.take_lattice(part, fine), nullptr);
  EXPECT_NE(allowance.take_lattice(part, fine), nullptr);
}

}  // namespace
}  // namespace vat::mesh_test
