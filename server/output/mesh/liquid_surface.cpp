#include "server/output/mesh/liquid_surface.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/support/check.h"
#include "server/output/mesh/level_set_grid.h"

namespace vat {

namespace {

// Range of a particle's weight, in radii. With this range, the distance of the surface from the
// centre is 0.64 spacings for a flat surface half a spacing above the highest layer of a cubic
// lattice: the weights of the layers are (1 - z^2 / range^2)^4. A sphere with this radius has 1.1
// times the volume of a cell of the lattice.
constexpr Real kRange = 4.8;
constexpr Real kDistance = 1.283;  // in radii
// Eigenvalues of the gradient of the mean position between which the surface retreats from hollow
// places (Solenthaler et al. 2007).
constexpr Real kLeastEigenvalue = 0.4;
constexpr Real kGreatestEigenvalue = 3.5;

/// Sums over the particles near each node of a block, one array per quantity.
struct BlockSums {
  using Column = std::array<Real, LevelSetGrid::kBlockNodes>;
  Column weight{};
  Column radius{};                    ///< weight times radius
  std::array<Column, 3> offset{};     ///< weight times distance vector to the particle
  std::array<Column, 3> slope{};      ///< gradient of the weight
  std::array<Column, 6> slope_off{};  ///< gradient times distance vector: xx, yy, zz, xy, xz, yz

  /// Adds a particle at nodes [begin, end) of a row. `at` is the distance vector of the first node.
  void add_row(std::size_t begin, std::size_t end, Vec3 at, Real cell, Real radius_of_particle);
};

void BlockSums::add_row(std::size_t begin, std::size_t end, Vec3 at, Real cell,
                        Real radius_of_particle) {
  const Real inverse = 1 / (kRange * radius_of_particle * kRange * radius_of_particle);
  const Real aside = at.y() * at.y() + at.z() * at.z();
  const Real y = at.y();
  const Real z = at.z();
  for (std::size_t n = begin; n < end; ++n) {
    const Real x = at.x() - cell * static_cast<Real>(n - begin);
    const Real rest = std::max(Real{0}, 1 - (x * x + aside) * inverse);
    const Real w = rest * rest * rest;
    const Real g = 6 * inverse * rest * rest;
    weight[n] += w;
    radius[n] += w * radius_of_particle;
    offset[0][n] += w * x;
    offset[1][n] += w * y;
    offset[2][n] += w * z;
    slope[0][n] += g * x;
    slope[1][n] += g * y;
    slope[2][n] += g * z;
    slope_off[0][n] += g * x * x;
    slope_off[1][n] += g * y * y;
    slope_off[2][n] += g * z * z;
    slope_off[3][n] += g * x * y;
    slope_off[4][n] += g * x * z;
    slope_off[5][n] += g * y * z;
  }
}

/// Returns the factor of the surface's distance at a node inside of the uncorrected surface.
Real retreat(const BlockSums& sums, std::size_t node, const Vec3& mean_offset) {
  const auto& m = sums.slope_off;
  Mat3 gradient;
  gradient << m[0][node], m[3][node], m[4][node],  //
      m[3][node], m[1][node], m[5][node],          //
      m[4][node], m[5][node], m[2][node];
  const Vec3 slope(sums.slope[0][node], sums.slope[1][node], sums.slope[2][node]);
  gradient = (gradient - mean_offset * slope.transpose()) / sums.weight[node];
  const Mat3 symmetric = (gradient + gradient.transpose()) / 2;
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(symmetric, Eigen::EigenvaluesOnly);
  const Real greatest = solver.eigenvalues()[2];
  if (greatest <= kLeastEigenvalue) return 1;
  const Real rest = (kGreatestEigenvalue - greatest) / (kGreatestEigenvalue - kLeastEigenvalue);
  return rest * (rest * (rest - 3) + 3);
}

/// Returns the distance from the surface at a node [m], negative inside of the liquid.
Real level_at(const BlockSums& sums, std::size_t node) {
  const Real weight = sums.weight[node];
  if (weight < 1e-12) return static_cast<Real>(LevelSetGrid::kOutside);
  const Vec3 mean_offset =
      Vec3(sums.offset[0][node], sums.offset[1][node], sums.offset[2][node]) / weight;
  const Real radius = kDistance * sums.radius[node] / weight;
  const Real level = mean_offset.norm() - radius;
  if (level >= 0) return level;
  return mean_offset.norm() - radius * retreat(sums, node, mean_offset);
}

/// Adds a particle to the sums of the nodes within its range.
void add_particle(const LevelSetGrid& grid, const LevelSetGrid::Block& block, const Vec3& position,
                  Real radius, BlockSums& sums) {
  constexpr int kEdge = LevelSetGrid::kEdgeNodes;
  const Real range = kRange * radius;
  std::array<int, 3> begin{};
  std::array<int, 3> end{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto first = static_cast<Real>(block.first_node[axis]);
    const Real center = position[static_cast<Eigen::Index>(axis)];
    const Real low = std::ceil((center - range) / grid.cell() - first);
    const Real high = std::floor((center + range) / grid.cell() - first) + 1;
    begin[axis] = static_cast<int>(std::clamp<Real>(low, 0, kEdge));
    end[axis] = static_cast<int>(std::clamp<Real>(high, begin[axis], kEdge));
  }
  for (int k = begin[2]; k < end[2]; ++k) {
    for (int j = begin[1]; j < end[1]; ++j) {
      const Vec3 at = position - grid.node_position(block, {begin[0], j, k});
      const std::size_t row = LevelSetGrid::node_index({0, j, k});
      sums.add_row(row + static_cast<std::size_t>(begin[0]), row + static_cast<std::size_t>(end[0]),
                   at, grid.cell(), radius);
    }
  }
}

}  // namespace

SurfaceMesh liquid_surface(std::span<const Vec3> positions, std::span<const Real> radii) {
  VAT_CHECK(positions.size() == radii.size());
  if (positions.empty()) return {};
  const auto [least, greatest] = std::ranges::minmax(radii);
  VAT_CHECK(least > 0);
  // Large particles among small ones determine the grid, because it has nodes at both.
  LevelSetGrid grid(std::max(least, greatest / 4));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    grid.touch(positions[i], kRange * radii[i], static_cast<Index>(i));
  }
  BlockSums sums;
  for (LevelSetGrid::Block& block : grid.make_blocks()) {
    sums = {};
    for (const Index i : block.particles) {
      add_particle(grid, block, positions[i], radii[i], sums);
    }
    for (std::size_t node = 0; node < LevelSetGrid::kBlockNodes; ++node) {
      block.levels[node] = static_cast<float>(level_at(sums, node));
    }
  }
  return grid.surface();
}

SurfaceMesh liquid_surface(std::span<const BodyView> bodies, std::string_view material) {
  std::vector<Vec3> positions;
  std::vector<Real> radii;
  for (const BodyView& body : bodies) {
    if (body.kind != BodyKind::liquid || body.material != material) continue;
    positions.insert(positions.end(), body.positions.begin(), body.positions.end());
    radii.insert(radii.end(), body.radii.begin(), body.radii.end());
  }
  return liquid_surface(positions, radii);
}

}  // namespace vat
