#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/liquid/pairs/pair_clusters.h"
#include "core/liquid/pairs/pair_sources.h"
#include "core/neighbours/cell_sorted_points.h"
#include "core/stage/scratch.h"

namespace vat {

/// What a pressure or viscosity pair reads of a liquid particle, one cache line.
struct LiquidRecord {
  Vec3 position;
  Real volume;  ///< m / rho [m^3]
  Vec3 velocity;
  Real pressure;  ///< [Pa]
};

/// Neighbours of one block of liquid slots: those of the block's k-th slot are
/// [begin[k], begin[k + 1]) of `slots`. One buffer a block, so that blocks are filled side by side.
struct PairBlock {
  std::vector<Index> slots;
  std::array<Index, kBlockSize + 1> begin;
};

/// How s of a liquid particle changes with its own place, and with others'.
struct VolumeSlope {
  Vec3 gradient;  ///< sum_j a_j g x of PairSums
  Real squares;   ///< sum_j a_j g^2 q^2
};

/// Buffers of liquids.
struct LiquidScratch {
  static constexpr Method kMethod = Method::liquid;

  CellSortedPoints liquid;
  // Of coupled liquids.
  PairSources sources;
  PairClusters liquid_clusters;            ///< pairs of liquid and all sources
  PairClusters solid_clusters;             ///< pairs of solids and liquid with its images
  std::uint64_t pairs_version = 0;         ///< of the sources that these were found among
  std::vector<VolumeSlope> volume_slopes;  ///< by liquid slot, of an incompressible liquid
  std::vector<PairViscosity> viscosities;  ///< by source, where liquids differ
  std::vector<Real> target_viscosities;    ///< by target, the same
  // Of the gas, and of coupled liquids where a stage asks for them.
  std::vector<LiquidRecord> liquid_records;  ///< by slot
  std::vector<PairBlock> liquid_pairs;
  bool too_many_pairs = false;  ///< above max_pairs(): the lists are not whole, a density is a NaN
  std::vector<Real> density;    ///< by liquid particle [kg/m^3]
  std::uint64_t density_version = 0;  ///< of the sources that it was summed over
  /// The same with all of the space beyond no-slip walls filled with the liquid at rest density.
  std::vector<Real> filled_density;
  std::vector<Real> filling;   ///< by liquid slot: density over filled density
  std::vector<Real> pressure;  ///< by liquid particle [Pa]
  // Solids in a weakly compressible liquid: their slots near those of the liquid, and the reverse.
  CellSortedPoints solids_in_liquid;  ///< index 0 is the first solid particle
  std::vector<PairBlock> solids_of_liquid;
  std::vector<PairBlock> liquid_of_solids;
  std::vector<Real> solid_pressure;  ///< by slot of solids_in_liquid [Pa]
};

}  // namespace vat
