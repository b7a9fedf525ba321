#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/neighbours/periodic_box.h"
#include "core/neighbours/uniform_grid.h"
#include "core/support/parallel.h"
#include "core/types.h"

namespace vat {

/// Points in the order of the cells of a UniformGrid. A slot is the position of a point in this
/// order. Each coordinate is a separate array, so that a compiler can vectorise distance tests over
/// consecutive slots.
struct CellSortedPoints {
  UniformGrid grid;
  std::vector<Real> x;
  std::vector<Real> y;
  std::vector<Real> z;
  std::vector<Vec3> wrapped;  ///< images in the box, in input order; periodic worlds only
  std::uint64_t version = 0;  ///< increases with each change of the points
  bool is_whole = false;      ///< false during build(), and after build() has thrown an exception

  /// Sorts `points` into cells of at least `cell_size` [m], which should be the search radius. In a
  /// periodic world, the points are replaced by their images in the box.
  void build(std::span<const Vec3> points, Real cell_size, const PeriodicBox& periodic,
             TaskRunner* runner = nullptr);
  /// Calls build(), unless the points are bitwise equal to those of the last call.
  void update(std::span<const Vec3> points, Real cell_size, const PeriodicBox& periodic,
              TaskRunner* runner);
};

}  // namespace vat
