#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/neighbours/periodic_box.h"
#include "core/neighbours/uniform_grid.h"
#include "core/support/parallel.h"
#include "core/types.h"

namespace vat {

/// Points in cell order. The coordinates are separate columns, so that a compiler can vectorise
/// distance tests over consecutive slots.
struct CellSortedPoints {
  UniformGrid grid;
  std::vector<Real> x;
  std::vector<Real> y;
  std::vector<Real> z;
  std::vector<Vec3> wrapped;  ///< the wrapped points in input order; periodic worlds only
  std::uint64_t version = 0;  ///< increases with each change of the points
  bool is_whole = false;      ///< false during sorting, and after a failed sort

  /// `cell_size` [m] should be the search radius. In a periodic world, the coordinates are those of
  /// the images in the box.
  void build(std::span<const Vec3> points, Real cell_size, const PeriodicBox& periodic,
             TaskRunner* runner = nullptr);
  /// Calls build(), unless the points have the same bits as in the last call.
  void update(std::span<const Vec3> points, Real cell_size, const PeriodicBox& periodic,
              TaskRunner* runner);
};

}  // namespace vat
