#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/neighbours/periodic_box.h"
#include "core/neighbours/uniform_grid.h"
#include "core/support/parallel.h"
#include "core/types.h"

namespace vat {

/// Points of one kind in cell order, coordinates in columns of their own so that a compiler can
/// vectorise distance tests over a run of slots.
struct CellSortedPoints {
  UniformGrid grid;
  std::vector<Real> x;
  std::vector<Real> y;
  std::vector<Real> z;
  std::vector<Vec3> wrapped;  ///< the points themselves, in their order; periodic worlds only
  std::uint64_t version = 0;  ///< rises whenever the points are other ones
  bool is_whole = false;      ///< false while they are sorted, or where that failed

  /// `cell_size`: best the search radius [m]. In a periodic world the coordinates are those of the
  /// images in the box.
  void build(std::span<const Vec3> points, Real cell_size, const PeriodicBox& periodic,
             TaskRunner* runner = nullptr);
  /// The same, but nothing is done where the points are those of the last time, to the bit.
  void update(std::span<const Vec3> points, Real cell_size, const PeriodicBox& periodic,
              TaskRunner* runner);
};

}  // namespace vat
