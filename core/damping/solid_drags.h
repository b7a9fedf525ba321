#pragma once

#include <array>
#include <vector>

#include "core/liquid/pairs/scratch.h"
#include "core/stage/context.h"
#include "core/state/state.h"

namespace vat {

struct ForceModel;

/// The viscous forces between a weakly compressible liquid and its solids, those of
/// add_tait_forces() and add_tait_forces_on_solids(), as a symmetric, negative semi-definite matrix
/// D; see DampingMatrix.
class SolidDrags {
 public:
  /// Collects the forces of the configuration at which `force_model` was last evaluated.
  void collect(const ForceModel& force_model);
  /// force += D w, with an entry for each particle.
  void add(const ForceModel& force_model, const std::vector<Vec3>& w,
           std::vector<Vec3>& force) const;

 private:
  /// f = -strength x x^T (w - w_other).
  struct Drag {
    Index other;    ///< particle
    Real strength;  ///< divided by |x|^2 [N s/m^3]
    Vec3 x;         ///< [m]
  };
  struct Block {
    std::vector<Drag> drags;
    std::array<Index, kBlockSize + 1> begin;  ///< by slot
  };
  /// Collects the forces on `from`, whose first particle is `first`, by its neighbours in `to`,
  /// listed in `near`.
  static void collect_of(const ForceModel& f, const CellSortedPoints& from, Index first,
                         const CellSortedPoints& to, Index other_first,
                         const std::vector<PairBlock>& near, std::vector<Block>& blocks);
  static void add_of(const ForceModel& f, const CellSortedPoints& from, Index first,
                     const std::vector<Block>& blocks, const std::vector<Vec3>& w,
                     std::vector<Vec3>& force);

  std::vector<Block> of_liquid_;
  std::vector<Block> of_solids_;
};

}  // namespace vat
