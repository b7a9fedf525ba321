#include "core/numerics/band_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

namespace vat::band_factor_test {
namespace {

using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

/// A positive definite matrix of blocks that are coupled up to `width`, once as a band and once in
/// full.
struct Case {
  Case(std::size_t rows, std::size_t width) : full(Matrix::Zero(size(rows), size(rows))) {
    band.clear(rows, width);
    for (std::size_t i = 0; i < rows; ++i) {
      add(i, i, Mat3::Identity());
      for (std::size_t j = i - std::min(i, width); j < i; ++j) {
        const auto angle = static_cast<Real>(3 * i + j);
        const Vec3 n(std::sin(angle), std::cos(angle), std::sin(2 * angle));
        const Mat3 spring = (1 + angle) * n * n.transpose();
        add(i, i, spring);
        add(j, j, spring);
        // The order of row and column has no effect.
        if ((i + j) % 2 == 0) {
          add(i, j, -spring);
        } else {
          add(j, i, -spring);
        }
      }
    }
  }
  void add(std::size_t i, std::size_t j, const Mat3& block) {
    band.add(i, j, block);
    full.block<3, 3>(size(i), size(j)) += block;
    if (i != j) full.block<3, 3>(size(j), size(i)) += block;
  }
  static Eigen::Index size(std::size_t rows) { return static_cast<Eigen::Index>(3 * rows); }

  BandFactor band;
  Matrix full;
};

TEST(BandFactor, SolvesLikeTheFullMatrix) {
  for (const auto& [rows, width] : {std::pair<std::size_t, std::size_t>{1, 0},
                                    {6, 0},
                                    {7, 1},
                                    {40, 3},
                                    {5, BandFactor::kMaxWidth},
                                    {60, BandFactor::kMaxWidth}}) {
    Case one(rows, width);
    std::vector<Vec3> values;
    for (std::size_t i = 0; i < rows; ++i)
      values.push_back(Vec3::Constant(1.0) * Real(i % 5) - Vec3::UnitY());
    const Eigen::Map<const Eigen::VectorXd> right(values[0].data(), Case::size(rows));
    const Eigen::VectorXd expected = one.full.llt().solve(right);
    ASSERT_TRUE(one.band.factor());
    one.band.solve(values);
    const Eigen::Map<const Eigen::VectorXd> found(values[0].data(), Case::size(rows));
    EXPECT_LT((found - expected).norm(), 1e-10 * expected.norm()) << rows << ' ' << width;
  }
}

TEST(BandFactor, RefusesAMatrixThatIsNotPositiveDefinite) {
  for (const Real pivot : {0.0, -1.0, std::nan("")}) {
    Case one(4, 1);
    one.band.add(2, 2, (pivot - one.full(6, 6)) * Mat3::Identity());
    EXPECT_FALSE(one.band.factor()) << pivot;
  }
}

TEST(BandFactor, CanBeUsedAgain) {
  Case one(10, 2);
  ASSERT_TRUE(one.band.factor());
  one.band.clear(2, 0);
  one.band.add(0, 0, 4 * Mat3::Identity());
  one.band.add(1, 1, 2 * Mat3::Identity());
  ASSERT_TRUE(one.band.factor());
  std::vector<Vec3> values = {Vec3(4, 8, 12), Vec3(2, 4, 6)};
  one.band.solve(values);
  for (const Vec3& value : values) EXPECT_LT((value - Vec3(1, 2, 3)).norm(), 1e-15);
}

}  // namespace
}  // namespace vat::band_factor_test
