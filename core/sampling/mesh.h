#pragma once

#include <array>
#include <vector>

#include "core/scene/scene.h"

namespace vat {

/// Volume inside a closed mesh [m^3], by the divergence theorem; negative if the triangles are
/// clockwise, seen from outside.
Real mesh_volume(const MeshShape& mesh);

/// Returns whether every edge is shared by as many triangles in one direction as in the other.
/// Vertices at the same position count as one, because exporters repeat them along seams.
bool is_closed(const MeshShape& mesh);

/// The vertical lines of a lattice, at x = first.x + i spacing and y = first.y + j spacing.
struct MeshLines {
  Vec3 first = Vec3::Zero();
  Real spacing = 0;
  std::array<Index, 2> count{};
};

/// The number of pairs of a triangle and a line to test: the cost of find_crossings().
Real crossing_work(const MeshShape& mesh, const MeshLines& lines);

/// The crossing of a line and the mesh. The winding number of a point on the line is the sum of
/// `turn` over the crossings above it.
struct MeshCrossing {
  std::size_t line = 0;  ///< j * count[0] + i
  Real z = 0;            ///< [m]
  int turn = 0;          ///< +1: the downward line enters the mesh, -1: it leaves it
};

/// All crossings, by line. A line through an edge crosses exactly one of the triangles of the edge.
std::vector<MeshCrossing> find_crossings(const MeshShape& mesh, const MeshLines& lines);

}  // namespace vat
