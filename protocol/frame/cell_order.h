#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vat {

/// Particles sorted by the cells of a cubic grid: FRAMES.md, "Order". Changes since a reference
/// frame are coded in this order. Reuses its memory.
class CellOrder {
 public:
  struct Cell {
    std::uint32_t begin = 0;  ///< index of its first particle in order()
    std::uint32_t end = 0;
    std::uint32_t place = 0;                ///< index in the box of all cells
    std::array<std::uint32_t, 3> before{};  ///< numbers of the neighbours at smaller x, y and z
  };

  /// Sorts `positions` (x, y, z of each particle) by cells of 2^shift quanta per axis. Returns
  /// false, with undefined content, if the box of cells is too large for the number of particles.
  bool sort(std::span<const std::uint16_t> positions, int shift);
  /// Sorts by cells of about eight particles. Returns the chosen shift.
  int sort(std::span<const std::uint16_t> positions);

  std::span<const std::uint32_t> order() const { return order_; }
  /// The occupied cells in ascending order of place. Element 0 has no particles and represents all
  /// empty cells.
  std::span<const Cell> cells() const { return cells_; }
  /// Returns the number of the cell at `place`, 0 if it is empty. `place` must be at most one cell
  /// away from a cell of cells().
  std::uint32_t cell_at(std::uint32_t place) const { return numbers_[place]; }
  std::uint32_t row() const { return row_; }      ///< difference of places along y
  std::uint32_t layer() const { return layer_; }  ///< difference of places along z

 private:
  /// Determines the box of cells. Returns false if it has too many.
  bool divide(std::size_t particles, int shift);
  /// Stores the place of each particle's cell and the number of particles per cell. Returns the
  /// number of occupied cells.
  std::size_t count_cells(std::span<const std::uint16_t> positions, int shift);
  void list_cells();
  void fill_order();

  std::vector<std::uint32_t> order_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> places_;   // by particle
  std::vector<std::uint32_t> numbers_;  // by place: particle counts, then cell numbers
  std::uint32_t row_ = 0;
  std::uint32_t layer_ = 0;
  std::uint32_t place_count_ = 0;
  std::array<std::uint16_t, 3> box_min_{};
  std::array<std::uint16_t, 3> box_max_{};
  std::array<std::uint32_t, 3> least_{};  ///< smallest cell coordinates
};

}  // namespace vat
