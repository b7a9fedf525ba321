#include "core/neighbours/uniform_grid.h"
#include "tests/support/distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace vat::uniform_grid_test {
namespace {

std::vector<Vec3> make_random_points(std::size_t count, Real low, Real high, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<Real> coordinate(low, high);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) p = {coordinate(random), coordinate(random), coordinate(random)};
  return points;
}

std::vector<Index> find_by_grid(const UniformGrid& grid, const std::vector<Vec3>& points,
                                const Vec3& p, Real radius) {
  std::vector<Index> found;
  grid.for_each_run(p, radius, [&](Index begin, Index end) {
    for (Index slot = begin; slot < end; ++slot) {
      const Index i = grid.order()[slot];
      if (test::distance_between(points[i], p) < radius) found.push_back(i);
    }
  });
  std::ranges::sort(found);
  return found;
}

std::vector<Index> find_by_brute_force(const std::vector<Vec3>& points, const Vec3& p,
                                       Real radius) {
  std::vector<Index> found;
  for (Index i = 0; i < points.size(); ++i) {
    if ((points[i] - p).norm() < radius) found.push_back(i);
  }
  return found;
}

/// Searches at every point and at some empty positions, with the cell size and other radii.
void expect_equals_brute_force(const std::vector<Vec3>& points, Real cell_size,
                               std::size_t stride = 1) {
  UniformGrid grid;
  grid.build(points, cell_size);
  ASSERT_EQ(grid.order().size(), points.size());
  for (const Real radius : {cell_size, cell_size / 3, cell_size * 2.5}) {
    for (std::size_t i = 0; i < points.size(); i += stride) {
      for (const Vec3& p : {points[i], Vec3(points[i] + Vec3(cell_size, -cell_size, 0.3))}) {
        ASSERT_EQ(find_by_grid(grid, points, p, radius), find_by_brute_force(points, p, radius))
            << points.size() << " points, radius " << radius << ", at " << p.transpose();
      }
    }
  }
}

TEST(UniformGrid, EqualsBruteForceForRandomPoints) {
  for (const std::size_t count : {0u, 1u, 2u, 3u, 10u, 255u, 256u, 257u, 1000u}) {
    expect_equals_brute_force(make_random_points(count, -1, 2, 7), 0.2);
  }
  expect_equals_brute_force(make_random_points(5000, -1, 1, 8), 0.1, 67);
}

TEST(UniformGrid, EqualsBruteForceOnCellFaces) {
  std::vector<Vec3> points;
  for (int x = -3; x <= 3; ++x) {
    for (int y = -3; y <= 3; ++y) {
      for (int z = -3; z <= 3; ++z) points.push_back(0.1 * Vec3(x, y, z));
    }
  }
  expect_equals_brute_force(points, 0.1);
  expect_equals_brute_force(points, 0.1 * (1 + 1e-15));
  expect_equals_brute_force(points, 0.1 * (1 - 1e-15));
  for (Vec3& p : points) p += Vec3::Constant(-1e5);  // coordinates with few significant digits left
  expect_equals_brute_force(points, 0.1);
}

TEST(UniformGrid, EqualsBruteForceForDegenerateAndFarPoints) {
  expect_equals_brute_force(std::vector<Vec3>(300, Vec3(-0.4, 7, 0)), 0.1, 50);
  std::vector<Vec3> line;
  for (int n = 0; n < 400; ++n) line.push_back({0, 0, 0.013 * n});
  expect_equals_brute_force(line, 0.05);
  std::vector<Vec3> points = make_random_points(500, -1, 1, 9);
  points.push_back({1e6, -1e6, 1e6});
  points.push_back({-1e6, 0, 3});
  expect_equals_brute_force(points, 0.2, 3);
}

TEST(UniformGrid, AcceptsAnyPositions) {
  constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
  constexpr Real kNaN = std::numeric_limits<Real>::quiet_NaN();
  std::vector<Vec3> points = make_random_points(100, -1, 1, 10);
  points.push_back({kNaN, 0, 0});
  points.push_back({kInfinity, -kInfinity, kNaN});
  points.push_back({1e300, -1e300, 0});
  UniformGrid grid;
  grid.build(points, 0.2);
  std::vector<Index> order(grid.order().begin(), grid.order().end());
  std::ranges::sort(order);
  for (Index i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
  for (Index i = 0; i < 100; ++i) {
    EXPECT_EQ(find_by_grid(grid, points, points[i], 0.2),
              find_by_brute_force(points, points[i], 0.2));
  }
}

// A search visits only cells within the radius.
TEST(UniformGrid, LooksAtFewPointsBeyondTheRadius) {
  const std::vector<Vec3> points = make_random_points(8000, 0, 2, 12);  // 1 per cell of 0.1
  UniformGrid grid;
  grid.build(points, 0.1);
  std::size_t looked_at = 0;
  for (const Vec3& p : points) {
    grid.for_each_run(p, 0.1, [&](Index begin, Index end) { looked_at += end - begin; });
  }
  EXPECT_LT(looked_at, 28 * points.size());  // 27 cells of one point each
}

TEST(UniformGrid, OrderIsStable) {
  // Four cells along x. Within a cell, points keep the order of the input.
  std::vector<Vec3> points;
  for (int n = 0; n < 100; ++n) points.push_back({0.5 + (n * 7) % 4, 0.5, 0.5});
  UniformGrid grid;
  grid.build(points, 1);
  const auto cell = [&](Index i) { return (i * 7) % 4; };
  const std::span<const Index> order = grid.order();
  for (std::size_t slot = 1; slot < order.size(); ++slot) {
    const Index before = order[slot - 1];
    const Index after = order[slot];
    EXPECT_TRUE(cell(before) < cell(after) || (cell(before) == cell(after) && before < after));
  }
}

TEST(UniformGrid, CanBeBuiltAgainWithOtherPoints) {
  UniformGrid grid;
  grid.build(make_random_points(1000, -1, 1, 13), 0.1);
  const std::vector<Vec3> points = make_random_points(50, 5, 6, 14);
  grid.build(points, 0.3);
  for (const Vec3& p : points) {
    EXPECT_EQ(find_by_grid(grid, points, p, 0.3), find_by_brute_force(points, p, 0.3));
  }
  grid.build({}, 0.3);
  EXPECT_TRUE(grid.order().empty());
  grid.for_each_run(Vec3::Zero(), 1, [](Index, Index) { FAIL() << "a run of an empty grid"; });
}

// Memory depends on the number of points, not on the space between them.
TEST(UniformGrid, HasLargerCellsForSparsePoints) {
  UniformGrid grid;
  const std::vector<Vec3> points = {Vec3::Constant(-1e6), Vec3::Constant(1e6)};
  grid.build(points, 1e-6);
  Index tried = 0;  // a point at 400 m: with 4096 cells per axis, one cell is 488 m wide
  grid.for_each_run(points[1] - Vec3::Constant(400), 1e-6,
                    [&](Index begin, Index end) { tried += end - begin; });
  EXPECT_EQ(tried, 1u);
  EXPECT_EQ(find_by_grid(grid, points, points[1], 1e-6), std::vector<Index>{1});
}

}  // namespace
}  // namespace vat::uniform_grid_test
