#include "core/numerics/band_factor.h"

#include <algorithm>
#include <cmath>

#include "core/support/check.h"

namespace vat {

void BandFactor::clear(std::size_t rows, std::size_t width) {
  VAT_CHECK(width <= kMaxWidth);
  size_ = 3 * rows;
  height_ = 3 * (width + 1);
  lower_.assign(size_ * height_, 0);
}

void BandFactor::add(std::size_t row, std::size_t column_of_block, Mat3 block) {
  if (row < column_of_block) {
    std::swap(row, column_of_block);
    block.transposeInPlace();
  }
  VAT_CHECK(3 * row < size_ && 3 * (row - column_of_block) < height_);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t j = 3 * column_of_block + c;
    for (std::size_t r = row == column_of_block ? c : 0; r < 3; ++r) {
      column(j)[3 * row + r - j] += block(static_cast<int>(r), static_cast<int>(c));
    }
  }
}

namespace {

/// Subtracts from a later column, given from its diagonal down, the parts of a block's columns.
void subtract_columns(Real* __restrict later, const Real* const (&own)[3], std::size_t count) {
  const Real factors[3] = {own[0][0], own[1][0], own[2][0]};
  if (factors[0] == 0 && factors[1] == 0 && factors[2] == 0) return;
  const Real* __restrict const a = own[0];
  const Real* __restrict const b = own[1];
  const Real* __restrict const c = own[2];
  for (std::size_t r = 0; r < count; ++r) {
    later[r] -= factors[0] * a[r] + factors[1] * b[r] + factors[2] * c[r];
  }
}

}  // namespace

bool BandFactor::factor() {
  for (std::size_t first = 0; first < size_; first += 3) {
    for (std::size_t j = first; j < first + 3; ++j) {
      Real* const own = column(j);
      if (!(own[0] > 0)) return false;
      const std::size_t height = height_of(j);
      const Real scale = 1 / std::sqrt(own[0]);
      for (std::size_t k = 0; k < height; ++k) own[k] *= scale;
      for (std::size_t later = j + 1; later < first + 3; ++later) {
        const Real factor = own[later - j];
        for (std::size_t r = later - j; r < height; ++r) {
          column(later)[r - (later - j)] -= factor * own[r];
        }
      }
    }
    // The band ends at the same row for the three columns of a block.
    const std::size_t end = first + height_of(first);
    for (std::size_t j = first + 3; j < end; ++j) {
      subtract_columns(column(j),
                       {column(first) + (j - first), column(first + 1) + (j - first - 1),
                        column(first + 2) + (j - first - 2)},
                       end - j);
    }
  }
  return true;
}

void BandFactor::solve(std::span<Vec3> values) const {
  VAT_CHECK(3 * values.size() == size_);
  if (values.empty()) return;
  Real* const x = values[0].data();
  for (std::size_t j = 0; j < size_; ++j) {
    const Real* const own = column(j);
    const std::size_t height = height_of(j);
    x[j] /= own[0];
    for (std::size_t k = 1; k < height; ++k) x[j + k] -= own[k] * x[j];
  }
  for (std::size_t j = size_; j-- > 0;) {
    const Real* const own = column(j);
    const std::size_t height = height_of(j);
    Real sum = x[j];
    for (std::size_t k = 1; k < height; ++k) sum -= own[k] * x[j + k];
    x[j] = sum / own[0];
  }
}

}  // namespace vat
