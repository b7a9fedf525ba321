#include <algorithm>
#include <cmath>

#include "protocol/frame/block_coder.h"
#include "protocol/frame/frame_layout.h"

namespace vat {
namespace {

using frame_layout::kMaxPlace;

/// Codes an integer with its sign in the lowest bit.
template <class Coder>
std::int32_t code_signed(Coder& coder, std::int32_t value) {
  const std::uint32_t magnitude = static_cast<std::uint32_t>(std::abs(value));
  const std::uint32_t coded = coder.whole(2 * magnitude + (value < 0 ? 1 : 0));
  if (coded / 2 > kMaxPlace) {
    coder.refuse();
    return 0;
  }
  const auto half = static_cast<std::int32_t>(coded / 2);
  return coded % 2 == 1 ? -half : half;
}

bool is_near_unit(const GridBlock& block) {
  double square = 0;
  for (const std::int32_t component : block.orientation) {
    square += static_cast<double>(component) * component;
  }
  const double one = std::ldexp(1.0, 2 * block.orientation_bits);
  return square >= 0.75 * one && square <= 1.25 * one;
}

template <std::size_t count>
using Numbers = std::array<std::int32_t, count>;

/// Returns first + turn * (first - second) / 256.
template <std::size_t count>
Numbers<count> extrapolated(const Numbers<count>& first, const Numbers<count>& second,
                            std::int64_t turn) {
  Numbers<count> result;
  for (std::size_t c = 0; c < count; ++c) {
    const std::int64_t step = std::int64_t{first[c]} - second[c];
    const std::int64_t value = first[c] + ((turn * step + 128) >> 8);
    result[c] = static_cast<std::int32_t>(std::clamp<std::int64_t>(value, -kMaxPlace, kMaxPlace));
  }
  return result;
}

template <std::size_t count>
std::uint32_t cheapest_class(const Numbers<count>& values, const Numbers<count>& predicted) {
  std::uint32_t best = 0;
  float least = 0;
  for (std::uint32_t index = 0; index < residuals::kClasses; ++index) {
    float cost = 0;
    for (std::size_t c = 0; c < count; ++c) cost += residual_cost(index, values[c] - predicted[c]);
    if (index > 0 && cost >= least) continue;
    best = index;
    least = cost;
  }
  return best;
}

template <class Coder, class Values, std::size_t count>
void code_numbers_near(Coder& coder, const Numbers<count>& predicted, Values& values) {
  std::uint32_t index = 0;
  if constexpr (!Coder::kReads) index = cheapest_class(values, predicted);
  index = coder.bits(index, kClassBits);
  if (index >= residuals::kClasses) return coder.refuse();
  for (std::size_t c = 0; c < count; ++c) {
    const auto lane = static_cast<std::uint32_t>(c % rans::kLanes);
    const std::int32_t left = coder.residual(values[c] - predicted[c], {index, 0}, lane);
    if (std::abs(predicted[c] + left) > kMaxPlace) return coder.refuse();
    keep<Coder>(values[c], predicted[c] + left);
  }
}

}  // namespace

template <class Coder>
void code_pose(Coder& coder, CodedBlock<Coder>& block) {
  for (auto& component : block.place) keep<Coder>(component, code_signed(coder, component));
  if (block.kind == GridBlock::Kind::vat) return;
  keep<Coder>(block.orientation_bits, coder.bits(block.orientation_bits, 5));
  for (auto& component : block.orientation) {
    keep<Coder>(component, code_signed(coder, component));
  }
  if (!is_near_unit(block)) coder.refuse();
}

template <class Coder>
void code_pose_change(Coder& coder, const GridBlock& first, const GridBlock* second,
                      std::int32_t turn, CodedBlock<Coder>& block) {
  const GridBlock& before = second != nullptr ? *second : first;
  code_numbers_near(coder, extrapolated(first.place, before.place, turn), block.place);
  if (block.kind == GridBlock::Kind::vat) return;
  code_numbers_near(coder, extrapolated(first.orientation, before.orientation, turn),
                    block.orientation);
  if (!is_near_unit(block)) coder.refuse();
}

template void code_pose(SymbolWriter&, const GridBlock&);
template void code_pose(SymbolReader&, GridBlock&);
template void code_pose_change(SymbolWriter&, const GridBlock&, const GridBlock*, std::int32_t,
                               const GridBlock&);
template void code_pose_change(SymbolReader&, const GridBlock&, const GridBlock*, std::int32_t,
                               GridBlock&);

}  // namespace vat
