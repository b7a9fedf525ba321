#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "protocol/frame/cell_order.h"
#include "protocol/frame/grid_frame.h"
#include "protocol/frame/neighbourhood.h"
#include "protocol/frame/symbols.h"

/// The coding of a frame's blocks: FRAMES.md, "Blocks". A Coder is a SymbolWriter, which reads its
/// blocks, or a SymbolReader, which fills them. Only the writer chooses parameters of the code. If
/// the reader refuses its input, the content of the block is undefined.
namespace vat {

inline constexpr std::uint32_t kEven = rans::kScale / 2;  ///< probability 1/2, of 4096
inline constexpr std::uint32_t kChanceBits = 12;
inline constexpr std::uint32_t kClassBits = 7;  ///< of residuals

/// Buffers that persist between frames, and the state of the current block.
struct BlockScratch {
  static constexpr std::uint32_t kNone = 0xffffffff;

  /// A residual and the parameters of its distribution.
  struct CodedResidual {
    std::int32_t value;
    std::uint8_t residual_class;
    std::int8_t fraction;
    std::uint8_t lane;
  };

  CellOrder cells;
  Neighbourhood neighbours;
  // Indexed by particle of the first reference's block: its index in the block of the second
  // reference and of the frame.
  std::vector<std::uint32_t> second_place;
  std::vector<std::uint32_t> new_place;
  std::vector<std::uint32_t>
      added;  ///< indices in the frame's block of particles not in the first reference
  std::vector<std::uint32_t> numbers;  ///< the particle numbers of `added`
  std::vector<Triple> mean_step;       ///< [eighths] by cell
  std::vector<std::array<std::int32_t, 4>>
      step_sums;                     ///< by cell; element 3 is the number of particles
  std::vector<CodedResidual> lefts;  ///< pending residuals of a writer
  std::vector<Triple> sizes;         ///< [eighths] of the residuals of added particles
};

template <class Coder>
using CodedBlock = std::conditional_t<Coder::kReads, GridBlock, const GridBlock>;
/// Assigns a decoded value if the coder is a reader.
template <class Coder, class T, class Value>
void keep(T& target, Value value) {
  if constexpr (Coder::kReads) target = static_cast<T>(value);
}

template <class Coder>
void code_key_block(Coder& coder, const FrameScale& scale, CodedBlock<Coder>& block,
                    BlockScratch& scratch);

/// Codes a block that has changed since `first`. A reader's block must have its body and kind.
/// `turn` is the extrapolation factor of poses, in 256ths.
template <class Coder>
void code_delta_block(Coder& coder, const FrameScale& scale, const GridBlock& first,
                      const GridBlock* second, std::int32_t turn, CodedBlock<Coder>& block,
                      BlockScratch& scratch);

// The parts of a block, one file each.

/// Codes the numbers of added particles, in ascending order.
template <class Coder>
void code_numbers(Coder& coder, std::vector<std::uint32_t>& numbers, std::size_t count);
/// Codes positions and attributes of the particles of scratch.added.
template <class Coder>
void code_added(Coder& coder, const FrameScale& scale, CodedBlock<Coder>& block,
                BlockScratch& scratch);
/// Codes the positions of remaining particles. Requires scratch.cells, second_place and new_place.
template <class Coder>
void code_positions(Coder& coder, const GridBlock& first, const GridBlock* second,
                    CodedBlock<Coder>& block, BlockScratch& scratch);
/// Codes those of the three attributes from `begin` that change.
template <class Coder>
void code_attributes(Coder& coder, const GridBlock& first, const GridBlock* second,
                     std::size_t begin, const ByAttribute<bool>& changes, CodedBlock<Coder>& block,
                     BlockScratch& scratch);
template <class Coder>
void code_pose_change(Coder& coder, const GridBlock& first, const GridBlock* second,
                      std::int32_t turn, CodedBlock<Coder>& block);
template <class Coder>
void code_pose(Coder& coder, CodedBlock<Coder>& block);

/// Factors have a resolution of 1/256.
inline constexpr std::uint32_t kFactorBits = 11;
inline constexpr std::int32_t kFactorOffset = 1024;
template <class Coder>
std::int32_t code_factor(Coder& coder, std::int32_t factor) {
  const auto coded = static_cast<std::uint32_t>(factor + kFactorOffset);
  return static_cast<std::int32_t>(coder.bits(coded, kFactorBits)) - kFactorOffset;
}

/// Returns the approximate number of bits of a residual in a class, for choices of the writer.
float residual_cost(std::uint32_t residual_class, std::int32_t residual);

}  // namespace vat
