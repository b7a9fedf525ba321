#include "core/step/workspace.h"

namespace vat {

void CellSortedPoints::build(std::span<const Vec3> points, Real cell_size) {
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
