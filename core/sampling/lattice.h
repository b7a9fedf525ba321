#pragma once

#include <array>
#include <vector>

#include "core/scene/body.h"

namespace vat {

/// Simple cubic lattice, centred on the bounding box of a shape. The number of points on each axis
/// is floor(extent / spacing), and at least 1. In two dimensions, the number of points along y is
/// 1. Shapes of explicit particles have no lattice.
struct Lattice {
  Vec3 first = Vec3::Zero();
  Real spacing = 0;  ///< [m]
  /// Number of points on each axis. The type is Real because the number of an invalid scene can
  /// exceed the range of an integer.
  std::array<Real, 3> size{0, 0, 0};
  Real point_count() const { return size[0] * size[1] * size[2]; }
};
Lattice make_lattice(const Shape& shape, Real spacing, int dimensions = 3);

/// Returns the number of pairs of a triangle and a lattice column that fill_lattice() tests. A
/// column is the set of lattice points with the same x and y.
Real lattice_work(const MeshShape& mesh, const Lattice& lattice);

/// Lattice point inside the shape.
struct LatticePoint {
  std::array<Index, 3> at{};
  Vec3 position;  ///< position in the frame of the shape
};
/// Returns the lattice points inside the shape. The index along x varies fastest.
std::vector<LatticePoint> fill_lattice(const Shape& shape, const Lattice& lattice);

}  // namespace vat
