#pragma once

#include <array>
#include <vector>

#include "core/liquid/pairs/scratch.h"
#include "core/stage/context.h"
#include "core/state/state.h"

namespace vat {

struct ForceModel;

/// The matrix D of the viscous forces between a weakly compressible liquid and its solids; see
/// DampingMatrix. D is symmetric and negative semi-definite. The forces are those of
/// add_tait_forces() and add_tait_forces_on_solids().
class SolidDrags {
 public:
  /// Collects the forces of the configuration at which `force_model` was last evaluated.
  void collect(const ForceModel& force_model);
  /// Adds D w to `force`, with one entry for each particle.
  void add(const ForceModel& force_model, const std::vector<Vec3>& w,
           std::vector<Vec3>& force) const;

 private:
  /// Drag force f = -strength x x^T (w - w_other).
  struct Drag {
    Index other;    ///< index of the other particle
    Real strength;  ///< drag coefficient / |x|^2 [N s/m^3]
    Vec3 x;         ///< separation of the particles [m]
  };
  struct Block {
    std::vector<Drag> drags;
    std::array<Index, kBlockSize + 1> begin;  ///< indexed by slot (index in cell order)
  };
  /// Collects the forces on the points `from` by their neighbours in `to`, which are listed in
  /// `near`. `first` is the first particle of `from`.
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
