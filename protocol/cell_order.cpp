#include "protocol/cell_order.h"

#include <algorithm>
#include <bit>

namespace vat {
namespace {

/// How many places the box of all cells may have.
std::uint64_t most_places(std::size_t particles) {
  return 4096 + 16 * std::uint64_t{particles};
}

}  // namespace

bool CellOrder::find_box(std::span<const std::uint16_t> positions, int shift) {
  std::array<std::uint16_t, 3> least{0xffff, 0xffff, 0xffff};
  std::array<std::uint16_t, 3> greatest{};
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], positions[i + axis]);
      greatest[axis] = std::max(greatest[axis], positions[i + axis]);
    }
  }
  // With a layer of empty places around.
  std::array<std::uint64_t, 3> sizes{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    least_[axis] = std::uint32_t{least[axis]} >> shift;
    sizes[axis] = (std::uint32_t{greatest[axis]} >> shift) - least_[axis] + 3;
  }
  const std::uint64_t count = sizes[0] * sizes[1] * sizes[2];
  if (count > most_places(positions.size() / 3)) return false;
  row_ = static_cast<std::uint32_t>(sizes[0]);
  layer_ = static_cast<std::uint32_t>(sizes[0] * sizes[1]);
  place_count_ = static_cast<std::uint32_t>(count);
  return true;
}

bool CellOrder::sort(std::span<const std::uint16_t> positions, int shift) {
  const std::size_t count = positions.size() / 3;
  cells_.assign(1, {});
  order_.resize(count);
  if (count == 0) return true;
  if (!find_box(positions, shift)) return false;
  numbers_.assign(place_count_, 0);
  places_.resize(count);
  const auto [x0, y0, z0] = least_;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t x = (std::uint32_t{positions[3 * i]} >> shift) - x0 + 1;
    const std::uint32_t y = (std::uint32_t{positions[3 * i + 1]} >> shift) - y0 + 1;
    const std::uint32_t z = (std::uint32_t{positions[3 * i + 2]} >> shift) - z0 + 1;
    places_[i] = z * layer_ + y * row_ + x;
    ++numbers_[places_[i]];
  }
  list_cells();
  for (std::size_t i = 0; i < count; ++i) {
    order_[cells_[numbers_[places_[i]]].end++] = static_cast<std::uint32_t>(i);
  }
  return true;
}

void CellOrder::list_cells() {
  std::uint32_t begin = 0;
  for (std::uint32_t place = 0; place < place_count_; ++place) {
    const std::uint32_t particles = numbers_[place];
    if (particles == 0) continue;
    numbers_[place] = static_cast<std::uint32_t>(cells_.size());
    Cell cell;
    cell.begin = cell.end = begin;
    cell.place = place;
    cell.before = {numbers_[place - 1], numbers_[place - row_], numbers_[place - layer_]};
    cells_.push_back(cell);
    begin += particles;
  }
}

int CellOrder::choose_shift(std::span<const std::uint16_t> positions) {
  constexpr std::size_t kMostInCell = 12;
  const std::size_t count = positions.size() / 3;
  int shift = 15;
  while (shift > 0 && find_box(positions, shift - 1)) {
    --shift;
    numbers_.assign(place_count_, 0);
    std::size_t occupied = 0;
    const auto [x0, y0, z0] = least_;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t x = (std::uint32_t{positions[3 * i]} >> shift) - x0 + 1;
      const std::uint32_t y = (std::uint32_t{positions[3 * i + 1]} >> shift) - y0 + 1;
      const std::uint32_t z = (std::uint32_t{positions[3 * i + 2]} >> shift) - z0 + 1;
      if (numbers_[z * layer_ + y * row_ + x]++ == 0) ++occupied;
    }
    if (count <= kMostInCell * occupied) break;
  }
  return shift;
}

}  // namespace vat
