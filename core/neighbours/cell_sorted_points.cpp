#include "core/neighbours/cell_sorted_points.h"

#include <atomic>

namespace vat {
namespace {

/// Returns whether `points` have the same bits as the sorted ones.
bool are_sorted(const CellSortedPoints& sorted, std::span<const Vec3> points,
                const PeriodicBox& periodic, TaskRunner* runner) {
  const std::span<const Index> order = sorted.grid.order();
  if (order.size() != points.size()) return false;
  std::atomic<bool> same = true;
  for_blocks(runner, order.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const Vec3& p = points[order[s]];
      if ((periodic.any() ? periodic.wrap(p) : p) == Vec3(sorted.x[s], sorted.y[s], sorted.z[s])) {
        continue;
      }
      same.store(false, std::memory_order_relaxed);
      return;
    }
  });
  return same;
}

}  // namespace

void CellSortedPoints::build(std::span<const Vec3> points, Real cell_size,
                             const PeriodicBox& periodic, TaskRunner* runner) {
  ++version;
  is_whole = false;
  if (periodic.any()) {
    wrapped.resize(points.size());
    for_blocks(runner, points.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) wrapped[i] = periodic.wrap(points[i]);
    });
    points = wrapped;
  }
  grid.build(points, cell_size, runner);
  x.resize(points.size());
  y.resize(points.size());
  z.resize(points.size());
  const std::span<const Index> order = grid.order();
  for_blocks(runner, order.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      const Vec3& p = points[order[slot]];
      x[slot] = p.x();
      y[slot] = p.y();
      z[slot] = p.z();
    }
  });
  is_whole = true;
}

void CellSortedPoints::update(std::span<const Vec3> points, Real cell_size,
                              const PeriodicBox& periodic, TaskRunner* runner) {
  if (is_whole && are_sorted(*this, points, periodic, runner)) return;
  build(points, cell_size, periodic, runner);
}

}  // namespace vat
