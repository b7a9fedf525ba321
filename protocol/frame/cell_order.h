#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vat {

/// Particles by the cells of a cubic grid, as FRAMES.md, "Order", says: the order in which what
/// has changed since a reference frame is coded. Keeps its memory.
class CellOrder {
 public:
  struct Cell {
    std::uint32_t begin = 0;  ///< of its particles in order()
    std::uint32_t end = 0;
    std::uint32_t place = 0;                ///< in the box of all cells
    std::array<std::uint32_t, 3> before{};  ///< the neighbours to the left, in front and below
  };

  /// Cells of 2^shift steps along each axis; of three coordinates each. False, and nothing is
  /// known, where the box of all cells would be too large for so few particles.
  bool sort(std::span<const std::uint16_t> positions, int shift);
  /// The same with the shift, which it gives, with which a cell holds about eight particles.
  int sort(std::span<const std::uint16_t> positions);

  std::span<const std::uint32_t> order() const { return order_; }
  /// Those that hold particles, in their order; before them one without, number 0, that stands for
  /// all others.
  std::span<const Cell> cells() const { return cells_; }
  /// The number of the cell there, 0 if it is empty; within one step of a cell of cells().
  std::uint32_t cell_at(std::uint32_t place) const { return numbers_[place]; }
  std::uint32_t row() const { return row_; }      ///< from a place to the one behind it
  std::uint32_t layer() const { return layer_; }  ///< and to the one above it

 private:
  /// Of the box and the size of cells: false where there are too many.
  bool divide(std::size_t particles, int shift);
  /// The place of each particle's cell, and how many are in it; how many cells have some.
  std::size_t count_cells(std::span<const std::uint16_t> positions, int shift);
  void list_cells();
  void fill_order();

  std::vector<std::uint32_t> order_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> places_;   // by particle
  std::vector<std::uint32_t> numbers_;  // by place: counts first, then numbers of cells
  std::uint32_t row_ = 0;
  std::uint32_t layer_ = 0;
  std::uint32_t place_count_ = 0;
  std::array<std::uint16_t, 3> box_min_{};
  std::array<std::uint16_t, 3> box_max_{};
  std::array<std::uint32_t, 3> least_{};  ///< of the cells
};

}  // namespace vat
