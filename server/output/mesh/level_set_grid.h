#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "server/output/mesh/shape_mesh.h"

namespace vat {

/// Sparse grid of a level set, and its zero surface as surface nets (Gibson 1998). The grid has
/// blocks of kEdgeCells^3 cells where particles are. Adjacent blocks repeat the nodes of their
/// common side.
class LevelSetGrid {
 public:
  static constexpr int kEdgeCells = 8;
  static constexpr int kEdgeNodes = kEdgeCells + 1;
  static constexpr std::size_t kBlockNodes = std::size_t{kEdgeNodes} * kEdgeNodes * kEdgeNodes;
  /// Level of nodes outside of the range of all particles.
  static constexpr float kOutside = std::numeric_limits<float>::max();

  /// Integer coordinates of a node, a cell (by its least node) or a block.
  using Place = std::array<std::int64_t, 3>;

  struct Block {
    Place first_node;
    std::vector<Index> particles;           ///< particles with nodes in range, ascending
    std::array<float, kBlockNodes> levels;  ///< negative inside
  };

  /// `cell` is the distance between nodes [m].
  explicit LevelSetGrid(Real cell) : cell_(cell) {}

  Real cell() const { return cell_; }
  /// Registers a particle whose range includes nodes. Particles must come in ascending order.
  void touch(const Vec3& position, Real range, Index particle);
  /// Creates the blocks of all registered particles. The caller then sets their levels.
  std::span<Block> make_blocks();
  /// Returns the surface between nodes with negative and other levels, oriented to the outside.
  SurfaceMesh surface() const;

  static std::size_t node_index(const std::array<int, 3>& node) {
    return static_cast<std::size_t>((node[2] * kEdgeNodes + node[1]) * kEdgeNodes + node[0]);
  }
  Vec3 node_position(const Block& block, const std::array<int, 3>& node) const {
    return {cell_ * static_cast<Real>(block.first_node[0] + node[0]),
            cell_ * static_cast<Real>(block.first_node[1] + node[1]),
            cell_ * static_cast<Real>(block.first_node[2] + node[2])};
  }

 private:
  struct Touch {
    Place block;
    Index particle;
  };

  Real cell_;
  std::vector<Touch> touches_;
  std::vector<Block> blocks_;
};

}  // namespace vat
