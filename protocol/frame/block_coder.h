#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "protocol/frame/cell_order.h"
#include "protocol/frame/grid_frame.h"
#include "protocol/frame/neighbourhood.h"
#include "protocol/frame/symbols.h"

/// How the blocks of a frame are coded: FRAMES.md, "Blocks". A Coder is a SymbolWriter, for which
/// blocks are given, or a SymbolReader, which fills them in. Code that chooses how something is
/// written runs for the former alone; what the latter refuses leaves anything in the block.
namespace vat {

inline constexpr std::uint32_t kEven = rans::kScale / 2;  ///< chances of what is as often true
inline constexpr std::uint32_t kChanceBits = 12;
inline constexpr std::uint32_t kClassBits = 7;  ///< of residuals

/// Memory that stays from frame to frame, and what is known of the block at hand.
struct BlockScratch {
  static constexpr std::uint32_t kNone = 0xffffffff;

  /// What a prediction left, and what was expected of it.
  struct CodedResidual {
    std::int32_t value;
    std::uint8_t residual_class;
    std::int8_t fraction;
    std::uint8_t lane;
  };

  CellOrder cells;
  Neighbourhood neighbours;
  // By particle of the first reference's block: its place in the second's, and in the frame's.
  std::vector<std::uint32_t> second_place;
  std::vector<std::uint32_t> new_place;
  std::vector<std::uint32_t> added;    ///< places in the frame's block of what the first has not
  std::vector<std::uint32_t> numbers;  ///< of those
  std::vector<Triple> mean_step;       ///< [eighths] by cell
  std::vector<std::array<std::int32_t, 4>> step_sums;  ///< by cell; the last counts
  std::vector<CodedResidual> lefts;                    ///< that a writer has to write
  std::vector<Triple> sizes;  ///< [eighths] of the residuals of added particles
};

template <class Coder>
using CodedBlock = std::conditional_t<Coder::kReads, GridBlock, const GridBlock>;
/// What has been coded goes where a reader wants it.
template <class Coder, class T, class Value>
void keep(T& target, Value value) {
  if constexpr (Coder::kReads) target = static_cast<T>(value);
}

template <class Coder>
void code_key_block(Coder& coder, const FrameScale& scale, CodedBlock<Coder>& block,
                    BlockScratch& scratch);

/// Of a block that has changed since `first`; of a reader's, body and kind are known. `turn` is
/// the factor of poses.
template <class Coder>
void code_delta_block(Coder& coder, const FrameScale& scale, const GridBlock& first,
                      const GridBlock* second, std::int32_t turn, CodedBlock<Coder>& block,
                      BlockScratch& scratch);

// The parts of a block, each in a file of its own.

/// The numbers of particles that come, rising.
template <class Coder>
void code_numbers(Coder& coder, std::vector<std::uint32_t>& numbers, std::size_t count);
/// Places and attributes of the particles of scratch.added.
template <class Coder>
void code_added(Coder& coder, const FrameScale& scale, CodedBlock<Coder>& block,
                BlockScratch& scratch);
/// Places and attributes of those that stay; scratch.cells, second_place and new_place are known.
template <class Coder>
void code_positions(Coder& coder, const GridBlock& first, const GridBlock* second,
                    CodedBlock<Coder>& block, BlockScratch& scratch);
/// Of the three attributes from `begin` on those that change; nothing where none does.
template <class Coder>
void code_attributes(Coder& coder, const GridBlock& first, const GridBlock* second,
                     std::size_t begin, const ByAttribute<bool>& changes, CodedBlock<Coder>& block,
                     BlockScratch& scratch);
template <class Coder>
void code_pose_change(Coder& coder, const GridBlock& first, const GridBlock* second,
                      std::int32_t turn, CodedBlock<Coder>& block);
template <class Coder>
void code_pose(Coder& coder, CodedBlock<Coder>& block);

/// Factors are in 256ths.
inline constexpr std::uint32_t kFactorBits = 11;
inline constexpr std::int32_t kFactorOffset = 1024;
template <class Coder>
std::int32_t code_factor(Coder& coder, std::int32_t factor) {
  const auto coded = static_cast<std::uint32_t>(factor + kFactorOffset);
  return static_cast<std::int32_t>(coder.bits(coded, kFactorBits)) - kFactorOffset;
}

/// What a residual costs in a class: about its bits, for choices that no reader sees.
float residual_cost(std::uint32_t residual_class, std::int32_t residual);

}  // namespace vat
