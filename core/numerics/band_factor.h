#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/types.h"

namespace vat {

/// Cholesky factor of a symmetric positive definite matrix of 3 x 3 blocks, in which block (i, j)
/// is zero for |i - j| > width. The factor has the same band and takes about 13.5 (width + 1)^2
/// multiplications and additions per block row. It runs on one thread, so that the result has the
/// same bits for any number of threads.
class BandFactor {
 public:
  /// Maximum width for which the factor is faster than conjugate gradients.
  static constexpr Index kMaxWidth = 32;

  /// Begins a matrix of `rows` block rows that is zero. `width` must be at most kMaxWidth.
  void clear(std::size_t rows, std::size_t width);
  /// Adds a block at (row, column) and, if row and column differ, its transpose at (column, row). A
  /// block on the diagonal must be symmetric.
  void add(std::size_t row, std::size_t column, Mat3 block);
  /// Replaces the matrix by its factor. Returns false if rounding makes a pivot zero or negative.
  /// The factor is undefined in this case.
  bool factor();
  /// Replaces the right-hand side, which has one entry per block row, by the solution.
  void solve(std::span<Vec3> values) const;

 private:
  Real* column(std::size_t index) { return lower_.data() + index * height_; }
  const Real* column(std::size_t index) const { return lower_.data() + index * height_; }

  /// The entries of a column from the diagonal down. All columns of a block end at the same row.
  std::size_t height_of(std::size_t index) const {
    return std::min(height_ - index % 3, size_ - index);
  }

  std::size_t size_ = 0;    ///< scalar rows
  std::size_t height_ = 0;  ///< scalar entries of the first column of a block
  std::vector<Real> lower_;
};

}  // namespace vat
