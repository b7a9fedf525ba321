#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/liquid/pairs/pair_clusters.h"
#include "core/liquid/pairs/pair_sources.h"
#include "core/neighbours/cell_sorted_points.h"
#include "core/stage/scratch.h"

namespace vat {

/// The data of a liquid particle for pressure and viscosity pairs, in one cache line.
struct LiquidRecord {
  Vec3 position;
  Real volume;  ///< m / rho [m^3]
  Vec3 velocity;
  Real pressure;  ///< [Pa]
};

/// Neighbours of one block of liquid slots. The neighbours of the block's k-th slot are
/// [begin[k], begin[k + 1]) of `slots`. Each block has its own buffer for parallel filling.
struct PairBlock {
  std::vector<Index> slots;
  std::array<Index, kBlockSize + 1> begin;
};

/// Derivatives of the sum s of a liquid particle with respect to positions.
struct VolumeSlope {
  Vec3 gradient;  ///< sum_j a_j g x of PairSums
  Real squares;   ///< sum_j a_j g^2 q^2
};

/// Buffers of liquids.
struct LiquidScratch {
  static constexpr Method kMethod = Method::liquid;

  CellSortedPoints liquid;
  // Coupled liquids (tait, incompressible):
  PairSources sources;
  PairClusters liquid_clusters;            ///< pairs of liquid and all sources
  PairClusters solid_clusters;             ///< pairs of solids and liquid with its images
  std::uint64_t pairs_version = 0;         ///< version of the sources in the clusters
  std::vector<VolumeSlope> volume_slopes;  ///< by liquid slot; incompressible liquids
  std::vector<PairViscosity> viscosities;  ///< by source, if viscosities differ
  std::vector<Real> target_viscosities;    ///< by target, if viscosities differ
  // The gas, and coupled liquids if a stage needs neighbour lists:
  std::vector<LiquidRecord> liquid_records;  ///< by slot
  std::vector<PairBlock> liquid_pairs;
  bool too_many_pairs = false;  ///< above max_pairs(): the lists are incomplete, a density is NaN
  std::vector<Real> density;    ///< by liquid particle [kg/m^3]
  std::uint64_t density_version = 0;  ///< version of the summed sources
  /// Density, computed as if liquid of rest density filled all space beyond no-slip walls [kg/m^3].
  std::vector<Real> filled_density;
  std::vector<Real> filling;   ///< by liquid slot: density / filled density
  std::vector<Real> pressure;  ///< by liquid particle [Pa]
  // Solids in coupled liquids: neighbour lists between liquid and solid slots.
  CellSortedPoints solids_in_liquid;  ///< index 0 is the first solid particle
  std::vector<PairBlock> solids_of_liquid;
  std::vector<PairBlock> liquid_of_solids;
  std::vector<Real> solid_pressure;  ///< by slot of solids_in_liquid [Pa]
};

}  // namespace vat
