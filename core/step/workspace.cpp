#include "core/step/workspace.h"

namespace vat {

void CellSortedPoints::build(std::span<const Vec3> points, Real cell_size,
                             const PeriodicBox& periodic) {
  if (periodic.any()) {
    wrapped.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) wrapped[i] = periodic.wrap(points[i]);
    points = wrapped;
  }
  grid.build(points, cell_size);
  x.resize(points.size());
  y.resize(points.size());
  z.resize(points.size());
  const std::span<const Index> order = grid.order();
  for (std::size_t slot = 0; slot < order.size(); ++slot) {
    const Vec3& p = points[order[slot]];
    x[slot] = p.x();
    y[slot] = p.y();
    z[slot] = p.z();
  }
}

}  // namespace vat
