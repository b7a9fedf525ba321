#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "core/kernels/kernel_id.h"
#include "core/scene/pair_precision.h"
#include "core/support/instruction_set.h"
#include "core/types.h"

namespace vat {

/// Position and weight of a source in sums over pairs. A source is a particle or an image of a
/// particle.
struct alignas(32) PairPlace {
  Real x, y, z;
  Real weight;  ///< rest volume times the scale of the kernel, dimensionless
};
struct alignas(32) PairMotion {
  Real pressure;
  Real vx, vy, vz;
};

/// Position of a source for sums in single precision, in coordinates of a PositionGrid.
struct alignas(16) PackedPlace {
  std::int32_t x, y, z;
  float weight;
};
struct alignas(16) PackedMotion {
  float pressure;
  float vx, vy, vz;
};

/// A grid of integer coordinates that is fine enough for distances in single precision. For an
/// extent of 100 support radii, rounding errors of positions are at most 1e-7 support radii.
struct PositionGrid {
  static constexpr std::int32_t kCount = 1 << 30;  ///< coordinates are in [0, kCount]
  /// Coordinate outside the grid, far from all sources.
  static constexpr std::int32_t kFar = -kCount / 2;

  Vec3 origin = Vec3::Zero();
  Real unit = 1;  ///< [m]
  Real inverse_unit = 1;

  PositionGrid() = default;
  /// Constructs a grid of size `span` > 0 [m] along each axis, with the lowest corner `corner`. The
  /// unit is a power of two.
  PositionGrid(const Vec3& corner, Real span);

  /// Returns the grid coordinate of `x`, clamped to [0, kCount]; 0 for a NaN.
  std::int32_t coordinate(Real x, int axis) const {
    const Real c = (x - origin[axis]) * inverse_unit;
    const Real above = c > 0 ? c : 0;  // without jumps, and false for a NaN
    const Real inside = above < kCount ? above : kCount;
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): lround() would be a function call
    return static_cast<std::int32_t>(inside + 0.5);
  }
  Vec3 place(const PackedPlace& p) const {
    return {origin.x() + unit * p.x, origin.y() + unit * p.y, origin.z() + unit * p.z};
  }
};
/// Coefficients of a source. The viscosity of a pair of different liquids is share * mu / (own * mu
/// + resistance), with the viscosity mu of the target.
struct PairViscosity {
  Real share;
  Real own;
  Real resistance;
};

/// A cluster of targets: the particles of one cell that are the sources [begin, end). The
/// candidates are all sources that may be within a support radius of a target, followed by padding.
struct TargetCluster {
  Vec3 center;  ///< centre of the box of the targets [m]
  Index begin = 0;
  Index end = 0;
  Index candidate_count = 0;        ///< a multiple of lane_count()
  Index mirrored_begin = 0;         ///< candidates from here on are images of liquid in walls
  std::size_t first_candidate = 0;  ///< index in the candidates of the chunk
  bool has_mirrored = false;        ///< the candidates include images in walls

  Index size() const { return end - begin; }
};
/// Maximum number of targets of a cluster.
inline constexpr Index kMaxTargets = 16;

struct PairInputs {
  // Arrays by source. Sums in double precision read the first two; sums in single precision read
  // the next two.
  const PairPlace* places = nullptr;
  const PairMotion* motions = nullptr;  ///< null if not read
  const PackedPlace* packed_places = nullptr;
  const PackedMotion* packed_motions = nullptr;  ///< null if not read
  PositionGrid grid;                             ///< grid of packed_places
  /// If null, the viscosity is mu for all sources, except 0 for images in walls.
  const PairViscosity* viscosities = nullptr;
  const Real* target_viscosities = nullptr;  ///< mu by target; null: `viscosity`
  Real viscosity = 0;                        ///< mu of all targets
  Real inverse_support = 0;                  ///< [1/m]
  Index first_mirrored = 0;                  ///< sources from here on are images in walls
  /// For `force` without viscosities by source: sources from here on add the terms of `drag`, with
  /// a factor of 1 in place of the pressures. None by default.
  Index first_dragging = std::numeric_limits<Index>::max();
  bool images_decide = false;         ///< for drag without viscosities by source: p_i counts as 0
  Index first_target = 0;             ///< the source whose sums are written first
  const Index* candidates = nullptr;  ///< of the chunk of the clusters

  /// Returns inputs for sums that begin with target `first`.
  PairInputs from_target(Index first) const {
    PairInputs in = *this;
    if (target_viscosities != nullptr) in.target_viscosities += first - first_target;
    in.first_target = first;
    return in;
  }
};

/// Sums over the candidates j for each target i of clusters, for one instruction set. a is the
/// weight of a source, p is the pressure, and v = v_i - v_j is the relative velocity. x is the
/// vector from source to target in units of the support radius, and q = |x|. w(q) is the kernel
/// divided by its scale. g(q) is w'(q) / q divided by a constant factor; see
/// SmoothingKernel::slope_scale(). Sources beyond the support radius add 0. A target is also one of
/// its own candidates (j = i). Its terms with the factor x are then 0.
struct PairSums {
  using Function = void (*)(const PairInputs&, std::span<const TargetCluster>, Real* sums);
  /// The sum_j a_j w; one number for each target.
  Function density;
  /// The sum_j a_j (-(p_i + p_j)) g x; three numbers for each target.
  Function pressure;
  /// The sum_j a_j (mu_ij v.x / (q^2 + 0.01/4) - (p_i + p_j)) g x; three numbers. The viscous force
  /// acts along x, so that angular momentum is conserved (J. J. Monaghan, Rep. Prog. Phys. 68
  /// (2005) 1703, sec. 4). The number 0.01/4 is Monaghan's 0.01 h^2 with the smoothing length h,
  /// which is half of the support radius. See also PairInputs::first_dragging.
  Function force;
  /// The sum_j a_j mu_ij max(p_i, p_j) / (q^2 + 0.01/4) g x_a^2 v_a for each axis a; three numbers.
  /// The sum is over candidates from TargetCluster::mirrored_begin on. Without viscosities by
  /// source, the sum includes only sources from first_mirrored on.
  Function drag;
  /// The sum_j a_j g x; three numbers.
  Function gradient;
  /// The sum_j g v_j.x; one number.
  Function divergence;
  /// The sums sum_j a_j w, sum_j a_j g x and sum_j a_j g^2 q^2; five numbers.
  Function volume;
  /// The sums sum_j a_j g x, sum_j a_j p_j g^2 q^2 and sum_j a_j vx_j |g| q; five numbers.
  Function response;
  /// The sums sum_j a_j w vx_j x, sum_j a_j w and sum_j a_j w p_j; five numbers.
  Function mean;
  /// The sum_j a_j w v_j; three numbers.
  Function blend;
  /// The sums sum_j a_j g v.x and sum_j a_j w; two numbers.
  Function spread;
};
inline constexpr std::size_t kVolumeSums = 5;
inline constexpr std::size_t kResponseSums = 5;
inline constexpr std::size_t kMeanSums = 5;
inline constexpr std::size_t kSpreadSums = 2;

/// Returns scalar loops for processors without SSSE3. The results are bitwise equal to those of the
/// baseline instruction set.
const PairSums& pair_sums_without_vectors(PairPrecision precision, KernelId kernel);

/// Returns the loops for the instruction set `set`, which the processor must support.
const PairSums& pair_sums(InstructionSet set, PairPrecision precision, KernelId kernel);

/// Coordinates of the slots of a SourceGroup [m].
struct CullSlots {
  const float* x;
  const float* y;
  const float* z;
  Index first_source;  ///< the source of slot 0
};

/// The lowest and highest coordinates of a box along each axis [m], and the maximum distance
/// `reach` of near sources [m].
struct CullBox {
  const float* low;
  const float* high;
  float reach;
};

/// The positions of the set bits of each byte, in ascending order. The rest is 0.
inline constexpr std::array kSelectedLanes = [] {
  std::array<std::array<std::uint8_t, 8>, 256> table{};
  for (std::size_t byte = 0; byte < table.size(); ++byte) {
    std::size_t count = 0;
    for (std::uint8_t bit = 0; bit < 8; ++bit) {
      if ((byte >> bit & 1) != 0) table[byte][count++] = bit;
    }
  }
  return table;
}();

/// A function that searches the slots [begin, end) for sources near `box`. It writes their indices
/// to `found`, starting at index `count`. The function returns the new count. `found` must have
/// space for all slots, plus lane_count() elements.
using CullFunction = std::size_t (*)(const CullSlots& slots, Index begin, Index end,
                                     const CullBox& box, Index* found, std::size_t count);
CullFunction cull_function(InstructionSet set);

/// Returns the number of single-precision numbers in a vector, at most 16.
std::size_t lane_count(InstructionSet set);

}  // namespace vat
