#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "protocol/frame/cell_order.h"
#include "protocol/frame/grid_frame.h"
#include "protocol/frame/neighbourhood.h"
#include "protocol/frame/symbols.h"

/// Coding of the blocks of a frame (FRAMES.md, "Blocks"). A Coder is a SymbolWriter or a
/// SymbolReader. A SymbolWriter encodes a given block, and a SymbolReader fills a block with
/// decoded values. Only the writer chooses coding parameters. If the reader rejects the input, the
/// content of the block is unspecified.
namespace vat {

inline constexpr std::uint32_t kEven = rans::kScale / 2;  ///< probability 1/2 in units of 1/4096
inline constexpr std::uint32_t kChanceBits = 12;
inline constexpr std::uint32_t kClassBits = 7;  ///< number of bits of a residual class

/// Reused buffers, and the state of the current block.
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
  // Both vectors have one element per particle of the first reference's block. second_place
  // contains indices in the second reference's block, new_place indices in the frame's block.
  std::vector<std::uint32_t> second_place;
  std::vector<std::uint32_t> new_place;
  /// Indices, in the frame's block, of particles that the first reference does not contain.
  std::vector<std::uint32_t> added;
  std::vector<std::uint32_t> numbers;  ///< particle numbers of `added`
  std::vector<Triple> mean_step;       ///< mean step of each cell [1/8 quantum]
  /// Sums of particle steps per cell [quantum]. Element 3 is the number of particles.
  std::vector<std::array<std::int32_t, 4>> step_sums;
  std::vector<CodedResidual> lefts;  ///< residuals that a writer has not written yet
  std::vector<Triple> sizes;         ///< residual magnitudes of added particles [1/8 quantum]
};

template <class Coder>
using CodedBlock = std::conditional_t<Coder::kReads, GridBlock, const GridBlock>;
/// Assigns `value` to `target` if the coder is a reader. Otherwise has no effect.
template <class Coder, class T, class Value>
void keep(T& target, Value value) {
  if constexpr (Coder::kReads) target = static_cast<T>(value);
}

template <class Coder>
void code_key_block(Coder& coder, const FrameScale& scale, CodedBlock<Coder>& block,
                    BlockScratch& scratch);

/// Codes a block that differs from `first`, the block of the first reference. The body and kind of
/// a reader's block must be set. `turn` is the extrapolation factor of poses in units of 1/256.
template <class Coder>
void code_delta_block(Coder& coder, const FrameScale& scale, const GridBlock& first,
                      const GridBlock* second, std::int32_t turn, CodedBlock<Coder>& block,
                      BlockScratch& scratch);

// Functions that code the parts of a block.

/// Codes the numbers of added particles, in ascending order.
template <class Coder>
void code_numbers(Coder& coder, std::vector<std::uint32_t>& numbers, std::size_t count);
/// Codes positions and attributes of the particles of scratch.added.
template <class Coder>
void code_added(Coder& coder, const FrameScale& scale, CodedBlock<Coder>& block,
                BlockScratch& scratch);
/// Codes the positions of particles that the first reference contains. Requires scratch.cells,
/// second_place and new_place.
template <class Coder>
void code_positions(Coder& coder, const GridBlock& first, const GridBlock* second,
                    CodedBlock<Coder>& block, BlockScratch& scratch);
/// Codes the changed attributes among the (at most three) attributes from index `begin`.
template <class Coder>
void code_attributes(Coder& coder, const GridBlock& first, const GridBlock* second,
                     std::size_t begin, const ByAttribute<bool>& changes, CodedBlock<Coder>& block,
                     BlockScratch& scratch);
template <class Coder>
void code_pose_change(Coder& coder, const GridBlock& first, const GridBlock* second,
                      std::int32_t turn, CodedBlock<Coder>& block);
template <class Coder>
void code_pose(Coder& coder, CodedBlock<Coder>& block);

/// Factors are coded in units of 1/256.
inline constexpr std::uint32_t kFactorBits = 11;
inline constexpr std::int32_t kFactorOffset = 1024;
template <class Coder>
std::int32_t code_factor(Coder& coder, std::int32_t factor) {
  const auto coded = static_cast<std::uint32_t>(factor + kFactorOffset);
  return static_cast<std::int32_t>(coder.bits(coded, kFactorBits)) - kFactorOffset;
}

/// Returns the approximate number of bits for a residual in a class. The encoder uses the number to
/// choose parameters.
float residual_cost(std::uint32_t residual_class, std::int32_t residual);

}  // namespace vat
