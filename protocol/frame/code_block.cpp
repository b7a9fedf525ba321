#include <algorithm>
#include <numeric>

#include "protocol/frame/block_coder.h"
#include "protocol/frame/frame_layout.h"

namespace vat {
namespace {

using frame_layout::has_attribute;

constexpr std::uint32_t kGridShiftBits = 4;

/// Returns the probability, of 4096, of a flag that is true `times` times in `cases`; at least 1.
std::uint32_t chances_of(std::size_t times, std::size_t cases) {
  const std::size_t chances = cases == 0 ? 0 : times * rans::kScale / cases;
  return static_cast<std::uint32_t>(std::clamp<std::size_t>(chances, 1, rans::kScale - 1));
}

template <class Coder>
std::uint32_t code_chances(Coder& coder, std::uint32_t chances) {
  chances = coder.bits(chances, kChanceBits);
  if (chances == 0) coder.refuse();
  return std::max(chances, 1U);
}

void resize_columns(const FrameScale& scale, std::size_t count, GridBlock& block) {
  block.positions.resize(3 * count);
  for (std::size_t a = 0; a < kFrameAttributes; ++a) {
    block.attributes[a].resize(has_attribute(block.kind, scale, a) ? count : 0);
  }
}

/// Writes for every particle of `from` its index in `to`, or BlockScratch::kNone.
void match(const GridBlock& from, const GridBlock& to, std::vector<std::uint32_t>& places) {
  const std::size_t count = from.particle_count();
  const std::size_t end = to.particle_count();
  places.resize(count);
  if (from.numbers == to.numbers && count == end) {
    std::iota(places.begin(), places.end(), 0U);
    return;
  }
  std::size_t j = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t number = from.number(i);
    if (to.numbers.empty()) {
      j = std::min<std::size_t>(number, end);
    } else {
      while (j < end && to.numbers[j] < number) ++j;
    }
    const bool is_there = j < end && to.number(j) == number;
    places[i] = is_there ? static_cast<std::uint32_t>(j) : BlockScratch::kNone;
  }
}

/// Lists the particles that were added since the first reference. Requires scratch.new_place.
void list_added(const GridBlock& block, BlockScratch& scratch) {
  scratch.added.clear();
  scratch.numbers.clear();
  std::size_t next = 0;
  const auto add_up_to = [&](std::size_t end) {
    for (; next < end; ++next) {
      scratch.added.push_back(static_cast<std::uint32_t>(next));
      scratch.numbers.push_back(block.number(next));
    }
  };
  for (const std::uint32_t place : scratch.new_place) {
    if (place == BlockScratch::kNone) continue;
    add_up_to(place);
    ++next;
  }
  add_up_to(block.particle_count());
}

/// Merges the remaining numbers of `first` with the added numbers, and sets their indices. Returns
/// false if an added number already exists.
bool merge_numbers(const GridBlock& first, GridBlock& block, BlockScratch& scratch) {
  std::vector<std::uint32_t>& numbers = block.numbers;
  numbers.clear();
  scratch.added.clear();
  std::size_t next = 0;
  const auto add_below = [&](std::uint64_t end) {
    for (; next < scratch.numbers.size() && scratch.numbers[next] < end; ++next) {
      scratch.added.push_back(static_cast<std::uint32_t>(numbers.size()));
      numbers.push_back(scratch.numbers[next]);
    }
  };
  for (std::size_t i = 0; i < first.particle_count(); ++i) {
    if (scratch.new_place[i] == BlockScratch::kNone) continue;
    const std::uint32_t number = first.number(i);
    add_below(number);
    if (next < scratch.numbers.size() && scratch.numbers[next] == number) return false;
    scratch.new_place[i] = static_cast<std::uint32_t>(numbers.size());
    numbers.push_back(number);
  }
  add_below(std::uint64_t{1} << 32);
  return true;
}

/// The parts that a delta block contains.
struct Parts {
  bool removes = false;
  std::uint32_t added = 0;
  bool moves = false;
  ByAttribute<bool> changes{};

  bool any_changes() const { return changes != ByAttribute<bool>{}; }
  bool needs_order() const { return removes || moves || any_changes(); }
};

template <std::size_t quantities, class T>
bool has_moved(const std::vector<T>& before, const std::vector<T>& now,
               const std::vector<std::uint32_t>& new_place) {
  for (std::size_t i = 0; i < new_place.size(); ++i) {
    if (new_place[i] == BlockScratch::kNone) continue;
    for (std::size_t q = 0; q < quantities; ++q) {
      if (before[quantities * i + q] != now[quantities * new_place[i] + q]) return true;
    }
  }
  return false;
}

Parts find_parts(const GridBlock& first, const GridBlock& block, const BlockScratch& scratch) {
  Parts parts;
  parts.removes =
      std::ranges::find(scratch.new_place, BlockScratch::kNone) != scratch.new_place.end();
  parts.added = static_cast<std::uint32_t>(scratch.added.size());
  parts.moves = has_moved<3>(first.positions, block.positions, scratch.new_place);
  for (std::size_t a = 0; a < kFrameAttributes; ++a) {
    if (block.attributes[a].empty()) continue;
    parts.changes[a] = has_moved<1>(first.attributes[a], block.attributes[a], scratch.new_place);
  }
  return parts;
}

template <class Coder>
void code_parts(Coder& coder, const FrameScale& scale, GridBlock::Kind kind, Parts& parts) {
  parts.removes = coder.flag(parts.removes, kEven);
  parts.added = coder.whole(parts.added);
  if (!coder.may_hold(parts.added)) coder.refuse();
  parts.moves = coder.flag(parts.moves, kEven);
  for (std::size_t a = 0; a < kFrameAttributes; ++a) {
    if (has_attribute(kind, scale, a)) parts.changes[a] = coder.flag(parts.changes[a], kEven);
  }
}

/// Sorts the first reference's particles by cells, which define the coding order.
template <class Coder>
void code_order(Coder& coder, const GridBlock& first, BlockScratch& scratch) {
  if constexpr (Coder::kReads) {
    const auto shift = static_cast<int>(coder.bits(0, kGridShiftBits));
    if (!scratch.cells.sort(first.positions, shift)) coder.refuse();
  } else {
    coder.bits(static_cast<std::uint32_t>(scratch.cells.sort(first.positions)), kGridShiftBits);
  }
}

/// Codes which particles were removed, with the previous particle's flag as context.
template <class Coder>
void code_removed(Coder& coder, BlockScratch& scratch) {
  const auto order = scratch.cells.order();
  std::array<std::uint32_t, 2> chances{};
  if constexpr (!Coder::kReads) {
    std::array<std::array<std::size_t, 2>, 2> counts{};
    bool before = false;
    for (const std::uint32_t i : order) {
      const bool is_gone = scratch.new_place[i] == BlockScratch::kNone;
      ++counts[before ? 1 : 0][is_gone ? 1 : 0];
      before = is_gone;
    }
    for (std::size_t b = 0; b < 2; ++b) {
      chances[b] = chances_of(counts[b][1], counts[b][0] + counts[b][1]);
    }
  }
  for (std::uint32_t& each : chances) each = code_chances(coder, each);
  bool before = false;
  for (const std::uint32_t i : order) {
    before = coder.flag(scratch.new_place[i] == BlockScratch::kNone, chances[before ? 1 : 0]);
    if constexpr (Coder::kReads) {
      if (before) scratch.new_place[i] = BlockScratch::kNone;
    }
  }
}

/// Copies unchanged positions and attributes from the first reference.
void keep_unmoved(const GridBlock& first, const Parts& parts, const BlockScratch& scratch,
                  GridBlock& block) {
  bool any = !parts.moves;
  for (std::size_t a = 0; a < kFrameAttributes; ++a) {
    any = any || (!block.attributes[a].empty() && !parts.changes[a]);
  }
  if (!any) return;
  for (std::size_t i = 0; i < scratch.new_place.size(); ++i) {
    const std::uint32_t place = scratch.new_place[i];
    if (place == BlockScratch::kNone) continue;
    if (!parts.moves) {
      std::copy_n(&first.positions[3 * i], 3, &block.positions[std::size_t{3} * place]);
    }
    for (std::size_t a = 0; a < kFrameAttributes; ++a) {
      if (block.attributes[a].empty() || parts.changes[a]) continue;
      block.attributes[a][place] = first.attributes[a][i];
    }
  }
}

/// Sets the block's particle numbers and sizes. Returns false if merge_numbers() does.
bool place_numbers(const GridBlock& first, const Parts& parts, const FrameScale& scale,
                   GridBlock& block, BlockScratch& scratch) {
  if (!parts.removes && parts.added == 0) {
    scratch.added.clear();
    block.numbers = first.numbers;
    resize_columns(scale, first.particle_count(), block);
    return true;
  }
  if (!merge_numbers(first, block, scratch)) return false;
  const std::size_t count = block.numbers.size();
  resize_columns(scale, count, block);
  drop_plain_numbers(count, block.numbers);
  return true;
}

template <class Coder>
void code_particle_changes(Coder& coder, const FrameScale& scale, const GridBlock& first,
                           const GridBlock* second, CodedBlock<Coder>& block,
                           BlockScratch& scratch) {
  Parts parts;
  if constexpr (Coder::kReads) {
    scratch.new_place.resize(first.particle_count());
    std::iota(scratch.new_place.begin(), scratch.new_place.end(), 0U);
  } else {
    match(first, block, scratch.new_place);
    list_added(block, scratch);
    parts = find_parts(first, block, scratch);
  }
  code_parts(coder, scale, block.kind, parts);
  if (!coder.is_sound()) return;
  if (parts.needs_order()) code_order(coder, first, scratch);
  if (!coder.is_sound()) return;
  if (parts.removes) code_removed(coder, scratch);
  code_numbers(coder, scratch.numbers, parts.added);
  if (!coder.is_sound()) return;
  if constexpr (Coder::kReads) {
    if (!place_numbers(first, parts, scale, block, scratch)) return coder.refuse();
    keep_unmoved(first, parts, scratch, block);
  }
  if (second != nullptr) match(first, *second, scratch.second_place);
  if (parts.moves) code_positions(coder, first, second, block, scratch);
  if (!coder.is_sound()) return;
  for (std::size_t begin = 0; begin < kFrameAttributes; begin += 3) {
    code_attributes(coder, first, second, begin, parts.changes, block, scratch);
    if (!coder.is_sound()) return;
  }
  if (coder.is_sound()) code_added(coder, scale, block, scratch);
}

template <class Coder>
void code_new_particles(Coder& coder, const FrameScale& scale, CodedBlock<Coder>& block,
                        BlockScratch& scratch) {
  const std::uint32_t count = coder.whole(static_cast<std::uint32_t>(block.particle_count()));
  if (!coder.may_hold(count)) return coder.refuse();
  const bool is_plain = coder.flag(block.numbers.empty(), kEven);
  scratch.added.resize(count);
  std::iota(scratch.added.begin(), scratch.added.end(), 0U);
  if constexpr (Coder::kReads) {
    block.numbers.clear();
    resize_columns(scale, count, block);
    if (!is_plain) code_numbers(coder, block.numbers, count);
    drop_plain_numbers(count, block.numbers);
  } else if (!is_plain) {
    scratch.numbers = block.numbers;
    code_numbers(coder, scratch.numbers, count);
  }
  if (coder.is_sound()) code_added(coder, scale, block, scratch);
}

/// Clears the fields of another kind, because a reader reuses blocks.
void clear_other_kind(GridBlock& block) {
  if (block.has_particles()) {
    block.place = {};
    block.orientation = {};
    block.orientation_bits = 0;
    return;
  }
  block.numbers.clear();
  block.positions.clear();
  for (auto& column : block.attributes) column.clear();
  if (block.kind == GridBlock::Kind::vat) {
    block.orientation = {};
    block.orientation_bits = 0;
  }
}

}  // namespace

template <class Coder>
void code_key_block(Coder& coder, const FrameScale& scale, CodedBlock<Coder>& block,
                    BlockScratch& scratch) {
  keep<Coder>(block.body, coder.whole(block.body));
  const std::uint32_t kind = coder.bits(static_cast<std::uint32_t>(block.kind), 2);
  keep<Coder>(block.kind, static_cast<GridBlock::Kind>(kind));
  if constexpr (Coder::kReads) clear_other_kind(block);
  if (block.has_particles()) {
    code_new_particles(coder, scale, block, scratch);
  } else {
    code_pose(coder, block);
  }
}

template <class Coder>
void code_delta_block(Coder& coder, const FrameScale& scale, const GridBlock& first,
                      const GridBlock* second, std::int32_t turn, CodedBlock<Coder>& block,
                      BlockScratch& scratch) {
  if constexpr (Coder::kReads) {
    block.body = first.body;
    block.kind = first.kind;
    clear_other_kind(block);
    block.orientation_bits = first.orientation_bits;
  }
  if (block.has_particles()) {
    code_particle_changes(coder, scale, first, second, block, scratch);
  } else {
    code_pose_change(coder, first, second, turn, block);
  }
}

template void code_key_block(SymbolWriter&, const FrameScale&, const GridBlock&, BlockScratch&);
template void code_key_block(SymbolReader&, const FrameScale&, GridBlock&, BlockScratch&);
template void code_delta_block(SymbolWriter&, const FrameScale&, const GridBlock&, const GridBlock*,
                               std::int32_t, const GridBlock&, BlockScratch&);
template void code_delta_block(SymbolReader&, const FrameScale&, const GridBlock&, const GridBlock*,
                               std::int32_t, GridBlock&, BlockScratch&);

}  // namespace vat
