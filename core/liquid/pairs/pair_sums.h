#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/kernels/kernel_id.h"
#include "core/scene/pair_precision.h"
#include "core/support/instruction_set.h"
#include "core/types.h"

namespace vat {

/// Position of a source in sums over pairs: a particle or its image. By source.
struct alignas(32) PairPlace {
  Real x, y, z;
  Real weight;  ///< rest volume times the scale of the kernel, dimensionless
};
struct alignas(32) PairMotion {
  Real pressure;
  Real vx, vy, vz;
};

/// Position of a source for sums in single precision, on the grid of a PositionGrid.
struct alignas(16) PackedPlace {
  std::int32_t x, y, z;
  float weight;
};
struct alignas(16) PackedMotion {
  float pressure;
  float vx, vy, vz;
};

/// A grid that is fine enough for distances in single precision. Over an extent of a hundred
/// support radii it rounds positions by at most 1e-7 support radii.
struct PositionGrid {
  static constexpr std::int32_t kCount = 1 << 30;  ///< coordinates are in [0, kCount]
  /// A coordinate far from all positions.
  static constexpr std::int32_t kFar = -kCount / 2;

  Vec3 origin = Vec3::Zero();
  Real unit = 1;  ///< [m]
  Real inverse_unit = 1;

  PositionGrid() = default;
  /// Covers `span` > 0 [m] from `corner` on along each axis. The unit is a power of two.
  PositionGrid(const Vec3& corner, Real span);

  /// The grid coordinate, clamped to the ends of the grid; 0 for a NaN.
  std::int32_t coordinate(Real x, int axis) const {
    const Real c = (x - origin[axis]) * inverse_unit;
    if (!(c > 0)) return 0;
    if (!(c < kCount)) return kCount;
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): not below 0, and lround() would be a call
    return static_cast<std::int32_t>(c + 0.5);
  }
  Vec3 place(const PackedPlace& p) const {
    return {origin.x() + unit * p.x, origin.y() + unit * p.y, origin.z() + unit * p.z};
  }
};
/// Viscosity of a pair of different liquids: mu share / (own mu + resistance), with mu of the
/// target.
struct PairViscosity {
  Real share;
  Real own;
  Real resistance;
};

/// Particles of one cell as targets of sums, sources [begin, end), and all sources that may be
/// within a support radius of one of them, with padding.
struct TargetCluster {
  Vec3 center;  ///< of the box of the targets [m]
  Index begin = 0;
  Index end = 0;
  Index candidate_count = 0;        ///< a multiple of lane_count()
  Index mirrored_begin = 0;         ///< candidates from here on are images of liquid in walls
  std::size_t first_candidate = 0;  ///< index in the candidates of the chunk
  bool has_mirrored = false;        ///< the candidates include images in walls

  Index size() const { return end - begin; }
};
/// Larger clusters are split.
inline constexpr Index kMaxTargets = 16;

struct PairInputs {
  // By source. Double precision reads the first two, single precision the next two.
  const PairPlace* places = nullptr;
  const PairMotion* motions = nullptr;  ///< null if not read
  const PackedPlace* packed_places = nullptr;
  const PackedMotion* packed_motions = nullptr;  ///< null if not read
  PositionGrid grid;                             ///< of packed places
  const PairViscosity* viscosities =
      nullptr;  ///< null: mu for all but mirror images, which have none
  const Real* target_viscosities = nullptr;  ///< mu by target; null: that of all
  Real viscosity = 0;                        ///< mu of all targets
  Real inverse_support = 0;                  ///< [1/m]
  Index first_mirrored = 0;                  ///< sources from here on are images in walls
  Index first_target = 0;                    ///< the source whose sums are written first
  const Index* candidates = nullptr;         ///< of the chunk of the clusters

  /// Inputs whose first sums are those of a later target.
  PairInputs from_target(Index first) const {
    PairInputs in = *this;
    if (target_viscosities != nullptr) in.target_viscosities += first - first_target;
    in.first_target = first;
    return in;
  }
};

/// Sums over pairs for clusters of targets, with one instruction set. Distances x from source to
/// target and q = |x| are divided by the support radius. w(q) is the kernel divided by its scale,
/// and g(q) = w'(q) / q divided by the factor of its polynomial; see SmoothingKernel. Sources
/// beyond the support radius add zero, and so does a target itself to terms with the factor x.
struct PairSums {
  using Function = void (*)(const PairInputs&, std::span<const TargetCluster>, Real* sums);
  /// sum_j a_j w; one number for each target.
  Function density;
  /// sum_j a_j (-(p_i + p_j)) g x; three numbers for each target.
  Function pressure;
  /// sum_j a_j (mu_ij v.x / (q^2 + 0.01/4) - (p_i + p_j)) g x, v = v_i - v_j; three numbers.
  /// Viscosity acts along x, so that it conserves angular momentum (J. J. Monaghan, Rep. Prog.
  /// Phys. 68 (2005) 1703, sec. 4).
  Function force;
  /// sum_j a_j mu_ij max(p_i, p_j) / (q^2 + 0.01/4) g x_a^2 v_a for each axis a; three numbers.
  /// Sources are those from first_mirrored on, or all if viscosities are given, among the
  /// candidates of clusters that are images of liquid or follow them.
  Function drag;
  /// sum_j a_j g x; three numbers.
  Function gradient;
  /// sum_j g v_j.x; one number.
  Function divergence;
  /// sum_j a_j w; sum_j a_j g x; sum_j a_j g^2 q^2; five numbers.
  Function volume;
  /// sum_j a_j g x; sum_j a_j p_j g^2 q^2; sum_j a_j vx_j |g| q; five numbers.
  Function response;
  /// sum_j a_j w vx_j x; sum_j a_j w; sum_j a_j w p_j; five numbers.
  Function mean;
};
inline constexpr std::size_t kVolumeSums = 5;
inline constexpr std::size_t kResponseSums = 5;
inline constexpr std::size_t kMeanSums = 5;

/// The baseline for processors without SSSE3: the same bits, one number at a time.
const PairSums& pair_sums_without_vectors(PairPrecision precision, KernelId kernel);

/// The sums for a set that this machine has.
const PairSums& pair_sums(InstructionSet set, PairPrecision precision, KernelId kernel);

/// Coordinates of the slots of a group [m].
struct CullSlots {
  const float* x;
  const float* y;
  const float* z;
  Index first_source;  ///< the source of slot 0
};

/// A box [m], by axis, and the distance from it that counts as near.
struct CullBox {
  const float* low;
  const float* high;
  float reach;
};

/// Appends the sources in the slots from `begin` to `end` that are near the box to `found` from
/// `count` on, and returns the new count. `found` must have space for all of them, and lane_count()
/// more.
using CullFunction = std::size_t (*)(const CullSlots& slots, Index begin, Index end,
                                     const CullBox& box, Index* found, std::size_t count);
CullFunction cull_function(InstructionSet set);

/// The number of single-precision numbers in a vector, at most 16.
std::size_t lane_count(InstructionSet set);

}  // namespace vat
