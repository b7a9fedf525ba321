#include "protocol/frame/cell_order.h"

#include <algorithm>

namespace vat {
namespace {

/// Returns the largest allowed number of places in the box of all cells.
std::uint64_t most_places(std::size_t particles) {
  return 4096 + 16 * std::uint64_t{particles};
}

/// Computes the bounding box of all positions. Blocks of eight particles let the compiler
/// vectorise.
void find_box(std::span<const std::uint16_t> positions, std::array<std::uint16_t, 3>& min,
              std::array<std::uint16_t, 3>& max) {
  constexpr std::size_t kSide = 24;
  std::array<std::uint16_t, kSide> least;
  std::array<std::uint16_t, kSide> greatest;
  least.fill(0xffff);
  greatest.fill(0);
  const std::size_t whole = positions.size() - positions.size() % kSide;
  for (std::size_t begin = 0; begin < whole; begin += kSide) {
    for (std::size_t k = 0; k < kSide; ++k) {
      least[k] = std::min(least[k], positions[begin + k]);
      greatest[k] = std::max(greatest[k], positions[begin + k]);
    }
  }
  for (std::size_t i = whole; i < positions.size(); ++i) {
    least[i % 3] = std::min(least[i % 3], positions[i]);
    greatest[i % 3] = std::max(greatest[i % 3], positions[i]);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    min[axis] = least[axis];
    max[axis] = greatest[axis];
    for (std::size_t k = axis; k < kSide; k += 3) {
      min[axis] = std::min(min[axis], least[k]);
      max[axis] = std::max(max[axis], greatest[k]);
    }
  }
}

}  // namespace

bool CellOrder::divide(std::size_t particles, int shift) {
  // An empty layer surrounds the occupied box.
  std::array<std::uint64_t, 3> sizes{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    least_[axis] = std::uint32_t{box_min_[axis]} >> shift;
    sizes[axis] = (std::uint32_t{box_max_[axis]} >> shift) - least_[axis] + 3;
  }
  const std::uint64_t count = sizes[0] * sizes[1] * sizes[2];
  if (count > most_places(particles)) return false;
  row_ = static_cast<std::uint32_t>(sizes[0]);
  layer_ = static_cast<std::uint32_t>(sizes[0] * sizes[1]);
  place_count_ = static_cast<std::uint32_t>(count);
  return true;
}

std::size_t CellOrder::count_cells(std::span<const std::uint16_t> positions, int shift) {
  numbers_.assign(place_count_, 0);
  places_.resize(positions.size() / 3);
  const std::uint32_t first = (least_[2] - 1) * layer_ + (least_[1] - 1) * row_ + least_[0] - 1;
  std::size_t occupied = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const std::uint32_t x = std::uint32_t{positions[3 * i]} >> shift;
    const std::uint32_t y = std::uint32_t{positions[3 * i + 1]} >> shift;
    const std::uint32_t z = std::uint32_t{positions[3 * i + 2]} >> shift;
    places_[i] = z * layer_ + y * row_ + x - first;  // modulo 2^32; the sum is exact
    occupied += numbers_[places_[i]]++ == 0 ? 1 : 0;
  }
  return occupied;
}

bool CellOrder::sort(std::span<const std::uint16_t> positions, int shift) {
  const std::size_t count = positions.size() / 3;
  cells_.assign(1, {});
  order_.resize(count);
  if (count == 0) return true;
  find_box(positions, box_min_, box_max_);
  if (!divide(count, shift)) return false;
  count_cells(positions, shift);
  fill_order();
  return true;
}

void CellOrder::fill_order() {
  list_cells();
  for (std::size_t i = 0; i < order_.size(); ++i) {
    order_[cells_[numbers_[places_[i]]].end++] = static_cast<std::uint32_t>(i);
  }
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

int CellOrder::sort(std::span<const std::uint16_t> positions) {
  constexpr std::size_t kMaxInCell = 12;
  constexpr int kCoarsest = 15;
  const std::size_t count = positions.size() / 3;
  cells_.assign(1, {});
  order_.resize(count);
  if (count == 0) return kCoarsest;
  find_box(positions, box_min_, box_max_);
  int shift = kCoarsest;
  while (shift > 0 && divide(count, shift - 1)) {
    --shift;
    if (count > kMaxInCell * std::size_t{place_count_}) continue;
    if (count > kMaxInCell * count_cells(positions, shift)) continue;
    fill_order();
    return shift;
  }
  // Smaller cells exceed the limit, or there are no particles.
  divide(count, shift);
  count_cells(positions, shift);
  fill_order();
  return shift;
}

}  // namespace vat
