#pragma once

#include <array>
#include <vector>

#include "core/step/workspace.h"

namespace vat {

/// The gradient of the kernel between a liquid particle and another, with respect to the place of
/// the liquid one, or of the other where the list is one of solids.
struct KernelGradient {
  Vec3 gradient;                   ///< [m^-4], in two dimensions [m^-3]
  Index slot;                      ///< of the other, or of its image in walls
  std::array<bool, 3> mirrored{};  ///< axes along which the image is reflected
};

/// Those of one block of slots: of the block's k-th slot [begin[k], begin[k + 1]).
struct GradientBlock {
  std::vector<KernelGradient> entries;
  std::array<Index, kBlockSize + 1> begin;
};

/// The places of a liquid at the start of a step, as sums over pairs need them while pressures and
/// velocities change.
struct PressurePairs {
  std::vector<LiquidRecord> records;      ///< by slot, with rest volumes; the rest is scratch
  std::vector<std::vector<Real>> slopes;  ///< by block: dW/dr / r of its liquid_pairs
  std::vector<GradientBlock> images;      ///< of liquid
  std::vector<GradientBlock> solids;      ///< by liquid slot, images included
  std::vector<GradientBlock> of_solids;   ///< by solid slot: the same pairs
  std::vector<Real> solid_volume;         ///< by solid slot [m^3]

  /// From the cells, pairs and solids of the workspace.
  void build(const StepContext& context);
};

}  // namespace vat
