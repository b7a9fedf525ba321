#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vat {

/// Particles sorted by the cells of a cubic grid (FRAMES.md, "Order"). Delta frames code changes in
/// this order. An object reuses its memory.
class CellOrder {
 public:
  struct Cell {
    std::uint32_t begin = 0;  ///< index of the cell's first particle in order()
    std::uint32_t end = 0;
    std::uint32_t place = 0;                ///< index of the cell in the box of all cells
    std::array<std::uint32_t, 3> before{};  ///< indices in cells() of neighbours at x-1, y-1, z-1
  };

  /// Sorts particles by cells with an edge of 2^shift quanta. `positions` contains x, y and z of
  /// each particle. Returns false if the box of cells is too large for the number of particles. The
  /// content is then unspecified.
  bool sort(std::span<const std::uint16_t> positions, int shift);
  /// Sorts particles by cells that contain about eight particles on average. Returns the chosen
  /// shift.
  int sort(std::span<const std::uint16_t> positions);

  std::span<const std::uint32_t> order() const { return order_; }
  /// Returns the occupied cells in ascending order of `place`. Element 0 contains no particles and
  /// represents all empty cells.
  std::span<const Cell> cells() const { return cells_; }
  /// Returns the index in cells() of the cell at `place`, or 0 if the cell is empty. `place` must
  /// be at most one cell away from an occupied cell.
  std::uint32_t cell_at(std::uint32_t place) const { return numbers_[place]; }
  std::uint32_t row() const { return row_; }      ///< difference of `place` along y
  std::uint32_t layer() const { return layer_; }  ///< difference of `place` along z

 private:
  /// Computes the box of cells. Returns false if the box contains too many cells.
  bool divide(std::size_t particles, int shift);
  /// Stores the place of each particle's cell and the number of particles per cell. Returns the
  /// number of occupied cells.
  std::size_t count_cells(std::span<const std::uint16_t> positions, int shift);
  void list_cells();
  void fill_order();

  std::vector<std::uint32_t> order_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> places_;   // indexed by particle
  std::vector<std::uint32_t> numbers_;  // indexed by place: particle counts, later cell indices
  std::uint32_t row_ = 0;
  std::uint32_t layer_ = 0;
  std::uint32_t place_count_ = 0;
  std::array<std::uint16_t, 3> box_min_{};
  std::array<std::uint16_t, 3> box_max_{};
  std::array<std::uint32_t, 3> least_{};  ///< smallest cell coordinates
};

}  // namespace vat
