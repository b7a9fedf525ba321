#include "server/output/mesh/level_set_grid.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace vat {

namespace {

using Node = std::array<int, 3>;
using Vertices = std::map<LevelSetGrid::Place, Index>;  // by cell

/// Returns the node that follows on an axis.
Node after(Node node, int axis) {
  ++node[static_cast<std::size_t>(axis)];
  return node;
}

/// Returns the mean of the places at which the surface crosses the edges of a cell, relative to its
/// least node, in cells. Returns false if the surface does not cross the cell.
bool find_vertex(const LevelSetGrid::Block& block, const Node& cell, Vec3& vertex) {
  std::array<float, 8> levels{};
  for (int corner = 0; corner < 8; ++corner) {
    levels[static_cast<std::size_t>(corner)] = block.levels[LevelSetGrid::node_index(
        {cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2 & 1)})];
  }
  int crossings = 0;
  vertex = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 8; ++corner) {
      if ((corner >> axis & 1) != 0) continue;
      const float begin = levels[static_cast<std::size_t>(corner)];
      const float end = levels[static_cast<std::size_t>(corner | 1 << axis)];
      if ((begin < 0) == (end < 0)) continue;
      Vec3 place(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
      place[axis] = static_cast<Real>(begin) / (static_cast<Real>(begin) - static_cast<Real>(end));
      vertex += place;
      ++crossings;
    }
  }
  if (crossings == 0) return false;
  vertex /= crossings;
  return true;
}

/// Adds a quadrangle as two triangles along its shorter diagonal.
void add_quadrangle(std::array<Index, 4> corners, bool is_turned, SurfaceMesh& mesh) {
  if (is_turned) std::swap(corners[1], corners[3]);
  const auto [a, b, c, d] = corners;
  const auto distance = [&](Index from, Index to) {
    return (mesh.vertices[from] - mesh.vertices[to]).squaredNorm();
  };
  if (distance(a, c) <= distance(b, d)) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  } else {
    mesh.triangles.push_back({a, b, d});
    mesh.triangles.push_back({b, c, d});
  }
}

LevelSetGrid::Place place_of(const LevelSetGrid::Block& block, const Node& node) {
  return {block.first_node[0] + node[0], block.first_node[1] + node[1],
          block.first_node[2] + node[2]};
}

void add_vertices(const LevelSetGrid::Block& block, Real cell_size, Vertices& vertices,
                  SurfaceMesh& mesh) {
  constexpr int kEdge = LevelSetGrid::kEdgeCells;
  Vec3 vertex;
  for (int k = 0; k < kEdge; ++k) {
    for (int j = 0; j < kEdge; ++j) {
      for (int i = 0; i < kEdge; ++i) {
        if (!find_vertex(block, {i, j, k}, vertex)) continue;
        const LevelSetGrid::Place place = place_of(block, {i, j, k});
        vertices.emplace(place, static_cast<Index>(mesh.vertices.size()));
        mesh.vertices.emplace_back(
            cell_size * (vertex + Vec3(static_cast<Real>(place[0]), static_cast<Real>(place[1]),
                                       static_cast<Real>(place[2]))));
      }
    }
  }
}

/// Adds a quadrangle between the four cells about each edge that the surface crosses.
void add_quadrangles(const LevelSetGrid::Block& block, const Vertices& vertices,
                     SurfaceMesh& mesh) {
  constexpr int kEdge = LevelSetGrid::kEdgeCells;
  for (int k = 0; k < kEdge; ++k) {
    for (int j = 0; j < kEdge; ++j) {
      for (int i = 0; i < kEdge; ++i) {
        const Node node = {i, j, k};
        const bool is_inside = block.levels[LevelSetGrid::node_index(node)] < 0;
        for (int axis = 0; axis < 3; ++axis) {
          const float end = block.levels[LevelSetGrid::node_index(after(node, axis))];
          if (is_inside == (end < 0)) continue;
          const auto second = static_cast<std::size_t>((axis + 1) % 3);
          const auto third = static_cast<std::size_t>((axis + 2) % 3);
          std::array<Index, 4> corners{};
          LevelSetGrid::Place cell = place_of(block, node);
          corners[0] = vertices.at(cell);
          --cell[second];
          corners[1] = vertices.at(cell);
          --cell[third];
          corners[2] = vertices.at(cell);
          ++cell[second];
          corners[3] = vertices.at(cell);
          add_quadrangle(corners, !is_inside, mesh);
        }
      }
    }
  }
}

}  // namespace

void LevelSetGrid::touch(const Vec3& position, Real range, Index particle) {
  Place low{};
  Place high{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const auto first = static_cast<std::int64_t>(std::ceil((position[axis] - range) / cell_));
    const auto last = static_cast<std::int64_t>(std::floor((position[axis] + range) / cell_));
    // A node on the common side belongs to both blocks.
    low[i] = static_cast<std::int64_t>(std::floor(static_cast<Real>(first - 1) / kEdgeCells));
    high[i] = static_cast<std::int64_t>(std::floor(static_cast<Real>(last) / kEdgeCells));
  }
  for (std::int64_t z = low[2]; z <= high[2]; ++z) {
    for (std::int64_t y = low[1]; y <= high[1]; ++y) {
      for (std::int64_t x = low[0]; x <= high[0]; ++x) touches_.push_back({{x, y, z}, particle});
    }
  }
}

std::span<LevelSetGrid::Block> LevelSetGrid::make_blocks() {
  std::ranges::stable_sort(touches_, {}, &Touch::block);
  const Place* last = nullptr;
  for (const Touch& touch : touches_) {
    if (last == nullptr || *last != touch.block) {
      Block& block = blocks_.emplace_back();
      block.first_node = {touch.block[0] * kEdgeCells, touch.block[1] * kEdgeCells,
                          touch.block[2] * kEdgeCells};
      last = &touch.block;
    }
    blocks_.back().particles.push_back(touch.particle);
  }
  return blocks_;
}

SurfaceMesh LevelSetGrid::surface() const {
  SurfaceMesh mesh;
  Vertices vertices;
  for (const Block& block : blocks_) add_vertices(block, cell_, vertices, mesh);
  for (const Block& block : blocks_) add_quadrangles(block, vertices, mesh);
  return mesh;
}

}  // namespace vat
