#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/liquid/pairs/pair_clusters.h"
#include "core/liquid/pairs/pair_sources.h"
#include "core/neighbours/cell_sorted_points.h"
#include "core/stage/scratch.h"

namespace vat {

/// The data of a liquid particle for sums of pressure and viscosity over pairs, in one cache line.
struct LiquidRecord {
  Vec3 position;
  Real volume;  ///< m / rho [m^3]
  Vec3 velocity;
  Real pressure;  ///< [Pa]
};

/// The neighbours of one block of slots. The neighbours of the k-th slot of the block are the
/// elements [begin[k], begin[k + 1]) of `slots`. Each block has a separate buffer, so that blocks
/// can be filled in parallel.
struct PairBlock {
  std::vector<Index> slots;
  std::array<Index, kBlockSize + 1> begin;
};

/// Derivatives of the relative density s of a liquid particle with respect to positions.
struct VolumeSlope {
  Vec3 gradient;  ///< sum_j a_j g x of PairSums
  Real squares;   ///< sum_j a_j g^2 q^2
};

/// Buffers of liquids. A slot is the position of a particle in the order of the cells.
struct LiquidScratch {
  static constexpr Method kMethod = Method::liquid;

  CellSortedPoints liquid;
  // Members for coupled liquids (solvers `tait` and `incompressible`):
  PairSources sources;
  PairClusters liquid_clusters;            ///< pairs of liquid with all sources
  PairClusters solid_clusters;             ///< pairs of solids with liquid and its images
  std::uint64_t pairs_version = 0;         ///< PairSources::version() of the clusters
  std::vector<VolumeSlope> volume_slopes;  ///< by liquid slot; only for incompressible liquids
  std::vector<PairViscosity> viscosities;  ///< by source; only if viscosities differ
  std::vector<Real> target_viscosities;    ///< by target; only if viscosities differ
  // Members for the solver `gas`, and for coupled liquids if a stage needs neighbour lists:
  std::vector<LiquidRecord> liquid_records;  ///< by slot
  std::vector<PairBlock> liquid_pairs;
  bool too_many_pairs = false;  ///< more than max_pairs(): lists are incomplete, a density is NaN
  std::vector<Real> density;    ///< by liquid particle [kg/m^3]
  std::uint64_t density_version = 0;  ///< PairSources::version() of `density`
  /// Density for a space beyond no-slip walls that is filled with liquid of rest density [kg/m^3].
  std::vector<Real> filled_density;
  std::vector<Real> filling;   ///< by liquid slot: density / filled density
  std::vector<Real> pressure;  ///< by liquid particle [Pa]
  // Members for solids in coupled liquids.
  CellSortedPoints solids_in_liquid;        ///< index 0 is the first solid particle
  std::vector<PairBlock> solids_of_liquid;  ///< neighbours of liquid slots, as slots of solids
  std::vector<Real> solid_pressure;         ///< by slot of solids_in_liquid [Pa]
};

}  // namespace vat
