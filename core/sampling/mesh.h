#pragma once

#include <array>
#include <vector>

#include "core/scene/body.h"

namespace vat {

/// Returns the volume inside a closed mesh [m^3], by the divergence theorem. The result is negative
/// if the triangles are clockwise, seen from outside.
Real mesh_volume(const MeshShape& mesh);

/// Returns whether each edge occurs equally often in both directions in the triangles. Vertices at
/// equal positions are merged, because exporters repeat vertices along seams.
bool is_closed(const MeshShape& mesh);

/// Vertical lines of a lattice, at x = first.x + i spacing and y = first.y + j spacing.
struct MeshLines {
  Vec3 first = Vec3::Zero();
  Real spacing = 0;
  std::array<Index, 2> count{};
};

/// Returns the number of pairs of a triangle and a line that find_crossings() tests.
Real crossing_work(const MeshShape& mesh, const MeshLines& lines);

/// Crossing of a line and the mesh. The winding number of a point on the line is the sum of `turn`
/// over the crossings above the point.
struct MeshCrossing {
  std::size_t line = 0;  ///< j * count[0] + i
  Real z = 0;            ///< [m]
  int turn = 0;          ///< +1: the downward line enters the mesh, -1: the line leaves it
};

/// Returns all crossings, ordered by line. A line through an edge crosses exactly one of the
/// triangles that share the edge.
std::vector<MeshCrossing> find_crossings(const MeshShape& mesh, const MeshLines& lines);

}  // namespace vat
