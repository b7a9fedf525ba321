#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/kernels/kernel_id.h"
#include "core/scene/pair_precision.h"
#include "core/support/instruction_set.h"
#include "core/types.h"

namespace vat {

/// One that acts in sums over pairs, a source: a particle, or its image. By source.
struct alignas(32) PairPlace {
  Real x, y, z;
  Real weight;  ///< rest volume times a kernel's scale, a pure number
};
struct alignas(32) PairMotion {
  Real pressure;
  Real vx, vy, vz;
};

/// The same for sums in single precision: places on the grid of a PlaceGrid.
struct alignas(16) PackedPlace {
  std::int32_t x, y, z;
  float weight;
};
struct alignas(16) PackedMotion {
  float pressure;
  float vx, vy, vz;
};

/// A grid so fine that distances on it are as good as in single precision about a place nearby:
/// over a span of a hundred support radii it rounds places by 1e-7 of them, at most.
struct PlaceGrid {
  static constexpr std::int32_t kCount = 1 << 30;  ///< coordinates are in [0, kCount]
  /// Of what is nowhere near a place.
  static constexpr std::int32_t kFar = -kCount / 2;

  Vec3 origin = Vec3::Zero();
  Real unit = 1;  ///< [m]
  Real inverse_unit = 1;

  PlaceGrid() = default;
  /// Covers `span` > 0 [m] from `origin` on along each axis; a power of two is its unit.
  PlaceGrid(const Vec3& corner, Real span);

  /// Beyond the grid, and of a NaN, that of its ends.
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
/// How viscous a pair is where liquids differ: mu share / (own mu + resistance), mu of the target.
struct PairViscosity {
  Real share;
  Real own;
  Real resistance;
};

/// Particles of one cell, which sums are made for: sources [begin, end), and all sources that may
/// be within a support radius of one of them, padded.
struct TargetCluster {
  Vec3 center;  ///< of the box around them [m]
  Index begin = 0;
  Index end = 0;
  Index candidate_count = 0;        ///< a multiple of lane_count()
  Index mirrored_begin = 0;         ///< candidates from here on are liquid's images in walls
  std::size_t first_candidate = 0;  ///< in the chunk's candidates
  bool has_mirrored = false;        ///< images in walls are among the candidates

  Index size() const { return end - begin; }
};
/// More are split.
inline constexpr Index kMaxTargets = 16;

struct PairInputs {
  // By source. Double precision reads the first two, single precision the next.
  const PairPlace* places = nullptr;
  const PairMotion* motions = nullptr;  ///< null where none are read
  const PackedPlace* packed_places = nullptr;
  const PackedMotion* packed_motions = nullptr;  ///< null where none are read
  PlaceGrid grid;                                ///< of packed places
  const PairViscosity* viscosities =
      nullptr;  ///< null: mu for all but mirror images, which have none
  const Real* target_viscosities = nullptr;  ///< mu by target; null: that of all
  Real viscosity = 0;                        ///< mu of all targets
  Real inverse_support = 0;                  ///< [1/m]
  Index first_mirrored = 0;                  ///< sources from here on are images in walls
  Index first_target = 0;                    ///< source whose sums come first
  const Index* candidates = nullptr;         ///< of the clusters' chunk

  /// With the sums of a later target first.
  PairInputs from_target(Index first) const {
    PairInputs in = *this;
    if (target_viscosities != nullptr) in.target_viscosities += first - first_target;
    in.first_target = first;
    return in;
  }
};

/// Sums over pairs for clusters of targets, with one instruction set. Distances x, q = |x| are over
/// the support radius, from the source to the target; w(q) is the kernel over its scale and
/// g(q) = w'(q) / q over its value's factor, see SmoothingKernel. Sources beyond the support add
/// zero, and so does a target to itself wherever x is a factor.
struct PairSums {
  using Function = void (*)(const PairInputs&, std::span<const TargetCluster>, Real* sums);
  /// sum_j a_j w; one number a target.
  Function density;
  /// sum_j a_j (-(p_i + p_j)) g x; three numbers a target.
  Function pressure;
  /// sum_j a_j (mu_ij v.x / (q^2 + 0.01/4) - (p_i + p_j)) g x, v = v_i - v_j; three numbers.
  /// Viscosity acts along x, so that it keeps angular momentum (J. J. Monaghan, Rep. Prog. Phys. 68
  /// (2005) 1703, sec. 4).
  Function force;
  /// sum_j a_j mu_ij max(p_i, p_j) / (q^2 + 0.01/4) g x_a^2 v_a for each axis a, over sources from
  /// first_mirrored on or, where viscosities are given, all, but only candidates of clusters that
  /// are or follow images of liquid; three numbers.
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

/// What the baseline is on processors without SSSE3: the same bits, one number at a time.
const PairSums& pair_sums_without_vectors(PairPrecision precision, KernelId kernel);

/// `set` must be one that the machine has.
const PairSums& pair_sums(InstructionSet set, PairPrecision precision, KernelId kernel);

/// Where the slots of a group are [m], each beside its coordinates on the other axes.
struct CullSlots {
  const float* x;
  const float* y;
  const float* z;
  Index first_source;  ///< the source of slot 0
};

/// A box [m], by axis, and how far around it is still near.
struct CullBox {
  const float* low;
  const float* high;
  float reach;
};

/// The sources in the slots from `begin` to `end` that are near the box, appended to `found` from
/// `count` on, which has room for all of them and lane_count() more; the new count.
using CullFunction = std::size_t (*)(const CullSlots& slots, Index begin, Index end,
                                     const CullBox& box, Index* found, std::size_t count);
CullFunction cull_function(InstructionSet set);

/// Numbers of single precision in a vector, 16 at most.
std::size_t lane_count(InstructionSet set);

}  // namespace vat
