#pragma once

#include <array>
#include <vector>

#include "core/scene/scene.h"

namespace vat {

/// A simple cubic lattice, centred on the bounding box of a shape. The number of points on each
/// axis is floor(extent / spacing), and at least one. In two dimensions, it is one on y. Not for
/// explicit particles.
struct Lattice {
  Vec3 first = Vec3::Zero();
  Real spacing = 0;                   ///< [m]
  std::array<Real, 3> size{0, 0, 0};  ///< number of points on each axis; of type Real because an
                                      ///< invalid scene can exceed the range of an integer
  Real point_count() const { return size[0] * size[1] * size[2]; }
};
Lattice make_lattice(const Shape& shape, Real spacing, int dimensions = 3);

/// The number of pairs of a triangle and a column of the lattice that fill_lattice() tests.
Real lattice_work(const MeshShape& mesh, const Lattice& lattice);

/// A lattice point inside the shape.
struct LatticePoint {
  std::array<Index, 3> at{};
  Vec3 position;  ///< in the frame of the shape
};
/// The lattice points inside the shape, x fastest.
std::vector<LatticePoint> fill_lattice(const Shape& shape, const Lattice& lattice);

}  // namespace vat
