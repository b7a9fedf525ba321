#pragma once

#include <array>
#include <vector>

#include "core/scene/scene.h"

namespace vat {

/// A simple cubic lattice over the bounding box of a shape and centred on it: along each axis as
/// many points as cells of `spacing` fit, at least one; in two dimensions one along y. Not for
/// explicit particles.
struct Lattice {
  Vec3 first = Vec3::Zero();
  Real spacing = 0;                   ///< [m]
  std::array<Real, 3> size{0, 0, 0};  ///< points per axis, whole; real, since a bad scene's is huge
  Real point_count() const { return size[0] * size[1] * size[2]; }
};
Lattice make_lattice(const Shape& shape, Real spacing, int dimensions = 3);

/// Pairs of a triangle and a column of the lattice that fill_lattice() has to try.
Real lattice_work(const MeshShape& mesh, const Lattice& lattice);

/// The lattice points inside the shape, x fastest.
struct LatticePoint {
  std::array<Index, 3> at{};
  Vec3 position;  ///< in the shape's frame
};
std::vector<LatticePoint> fill_lattice(const Shape& shape, const Lattice& lattice);

}  // namespace vat
