#include "core/neighbours/uniform_grid.h"

#include <algorithm>
#include <cmath>

#include "core/limits.h"
#include "core/support/check.h"
#include "core/support/grow.h"

namespace vat {

void UniformGrid::choose_cells(std::span<const Vec3> points, Real cell_size, TaskRunner* runner) {
  constexpr Real kFar = 1e3 * kMaxLength;  // beyond this distance the guard fails the step; here
                                           // the grid only has to stay finite
  boxes_.resize(block_count(points.size()));
  for_blocks(runner, points.size(), [&](std::size_t begin, std::size_t end) {
    Vec3 low = Vec3::Constant(kFar);
    Vec3 high = Vec3::Constant(-kFar);
    for (const Vec3& p : points.subspan(begin, end - begin)) {
      for (int axis = 0; axis < 3; ++axis) {  // a NaN changes neither bound
        low[axis] = p[axis] < low[axis] ? p[axis] : low[axis];
        high[axis] = p[axis] > high[axis] ? p[axis] : high[axis];
      }
    }
    boxes_[begin / kBlockSize] = {low, high};
  });
  Vec3 low = Vec3::Constant(kFar);
  Vec3 high = Vec3::Constant(-kFar);
  for (const auto& [block_low, block_high] : boxes_) {
    low = low.cwiseMin(block_low);
    high = high.cwiseMax(block_high);
  }
  low = low.cwiseMax(-kFar).cwiseMin(kFar);
  high = high.cwiseMin(kFar).cwiseMax(low);

  // Sparse points get larger cells. Cells need only be at least as large as the search radius.
  const Real most_cells = static_cast<Real>(std::max<std::size_t>(4096, 8 * points.size()));
  const auto cells_along = [&](int axis) {
    return std::floor((high[axis] - low[axis]) / cell_size) + 1;
  };
  while (cells_along(0) * cells_along(1) * cells_along(2) > most_cells) cell_size *= 2;

  origin_ = low;
  inverse_cell_size_ = 1 / cell_size;
  for (int axis = 0; axis < 3; ++axis) {
    count_[static_cast<std::size_t>(axis)] = static_cast<Index>(cells_along(axis));
  }
}

void UniformGrid::build(std::span<const Vec3> points, Real cell_size, TaskRunner* runner) {
  VAT_CHECK(cell_size > 0);
  choose_cells(points, cell_size, runner);
  const std::size_t cell_count = std::size_t{count_[0]} * count_[1] * count_[2];
  resize_closely(cell_begin_, cell_count + 2);
  VAT_CHECK(points.size() < std::numeric_limits<Index>::max());
  std::ranges::fill(cell_begin_, 0);
  resize_closely(cell_of_, points.size());
  resize_closely(order_, points.size());

  for_blocks(runner, points.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3& p = points[i];
      const Index x = coordinate(p.x(), 0);
      const Index y = coordinate(p.y(), 1);
      const Index z = coordinate(p.z(), 2);
      cell_of_[i] = (z * count_[1] + y) * count_[0] + x;
    }
  });
  // The filling moves each beginning to its end, which is the beginning of the next cell. Counts
  // and beginnings are therefore stored one element further.
  for (const Index cell : cell_of_) ++cell_begin_[cell + 2];
  Index begin = 0;
  for (Index& count : std::span(cell_begin_).subspan(1, cell_count)) count = begin += count;
  for (std::size_t i = 0; i < points.size(); ++i) {
    order_[cell_begin_[cell_of_[i] + 1]++] = static_cast<Index>(i);
  }
  cell_begin_.pop_back();
  VAT_CHECK(cell_begin_.back() == points.size());
}

}  // namespace vat
