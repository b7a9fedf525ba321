#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/support/check.h"
#include "core/support/parallel.h"
#include "core/types.h"

namespace vat {

/// A grid of cubic cells with points sorted by cell, then by index. A slot is the position of a
/// point in this order. The x coordinate of the cells varies fastest, so that a search visits few
/// contiguous runs of slots. Non-finite positions are accepted. Sparse points get larger cells, so
/// that memory is linear in the number of points.
class UniformGrid {
 public:
  /// Sorts `points` into cells of at least `cell_size` > 0 [m], which should be the search radius.
  void build(std::span<const Vec3> points, Real cell_size, TaskRunner* runner = nullptr);

  /// Returns the index of the point in each slot. The slots of a cell are contiguous.
  std::span<const Index> order() const { return order_; }
  /// Returns the first slot of each cell, followed by the total number of slots. A cell may be
  /// empty.
  std::span<const Index> cell_begin() const { return cell_begin_; }
  /// Returns the corner of the grid with the lowest coordinates [m].
  const Vec3& origin() const { return origin_; }
  /// Returns the corner of the grid with the highest coordinates [m].
  Vec3 end() const { return origin_ + Vec3(count_[0], count_[1], count_[2]) / inverse_cell_size_; }

  /// Calls f(begin, end) for disjoint runs of slots that contain every point closer to `p` than
  /// `radius`. The runs may contain other points.
  template <class F>
  void for_each_run(const Vec3& p, Real radius, F&& f) const {
    const Real reach = radius * (1 + 1e-6);  // more than the rounding error of p - radius
    for_each_run(p.array() - reach, p.array() + reach, f);
  }

  /// Calls f(begin, end) for disjoint runs of slots that contain every point in a box, faces
  /// included. The runs may contain other points.
  template <class F>
  void for_each_run(const Vec3& lowest, const Vec3& highest, F&& f) const {
    if (order_.empty()) return;
    std::array<Index, 3> low;
    std::array<Index, 3> high;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<Eigen::Index>(axis);
      low[axis] = coordinate(lowest[a], axis);
      high[axis] = coordinate(highest[a], axis);
    }
    for (Index z = low[2]; z <= high[2]; ++z) {
      for (Index y = low[1]; y <= high[1]; ++y) {
        VAT_ASSERT(low[0] <= high[0] && high[0] < count_[0] && y < count_[1] && z < count_[2]);
        const std::size_t row = (static_cast<std::size_t>(z) * count_[1] + y) * count_[0];
        const Index begin = cell_begin_[row + low[0]];
        const Index end = cell_begin_[row + high[0] + 1];
        if (begin < end) f(begin, end);
      }
    }
  }

 private:
  /// Returns the cell coordinate along `axis`, clamped to the grid. The result increases
  /// monotonically with `x`, and is 0 for a NaN.
  Index coordinate(Real x, std::size_t axis) const {
    const Real c = (x - origin_[static_cast<Eigen::Index>(axis)]) * inverse_cell_size_;
    if (!(c > 0)) return 0;
    const Index last = count_[axis] - 1;
    return c >= last ? last : static_cast<Index>(c);
  }
  void choose_cells(std::span<const Vec3> points, Real cell_size, TaskRunner* runner);

  Vec3 origin_ = Vec3::Zero();
  Real inverse_cell_size_ = 1;
  std::array<Index, 3> count_{1, 1, 1};
  std::vector<Index> cell_begin_;  // first slot by cell, then the total number of slots
  std::vector<Index> cell_of_;     // cell of each point
  std::vector<Index> order_;
  std::vector<std::array<Vec3, 2>> boxes_;  // lowest and highest corner of each block of points
};

}  // namespace vat
