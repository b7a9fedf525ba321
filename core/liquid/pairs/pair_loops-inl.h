// The loops of PairSums for one instruction set. This file is included once for each instruction
// set, which requires the toggling include guard of Highway.
#if defined(VAT_PAIR_LOOPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VAT_PAIR_LOOPS_INL_H
#undef VAT_PAIR_LOOPS_INL_H
#else
#define VAT_PAIR_LOOPS_INL_H
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include <hwy/highway.h>

#include "core/liquid/pairs/pair_sums.h"
#include "core/liquid/pairs/pair_terms-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vat::HWY_NAMESPACE {
namespace {

/// Number of terms per sum. Without vectors, several terms represent the lanes of a vector of 16
/// bytes, so that the sums are bitwise equal to those of a 16-byte vector.
template <class T>
inline constexpr std::size_t kTerms = Simd<T>::kCount == 1 ? 16 / sizeof(T) : 1;

/// Number of candidates that a loop processes at once, or a multiple of this number. The number of
/// candidates of a cluster is a multiple of kBatch.
inline constexpr std::size_t kBatch =
    std::max<std::size_t>(4, hn::MaxLanes(hn::ScalableTag<float>()));

/// The terms of one target.
template <class T, class Term>
using Terms = std::array<Term, kTerms<T>>;

/// Number of targets whose sums are computed together.
inline constexpr Index kTargetGroup = 4;

#if HWY_TARGET <= HWY_AVX2

/// Returns the sum of the halves of a vector of 64 bytes, or a vector of 32 bytes itself.
HWY_INLINE hn::Vec<hn::FixedTag<float, 8>> fold(hn::Vec<hn::FixedTag<float, 8>> v) {
  return v;
}
#if HWY_TARGET <= HWY_AVX3
HWY_INLINE hn::Vec<hn::FixedTag<float, 8>> fold(hn::Vec<hn::FixedTag<float, 16>> v) {
  const hn::FixedTag<float, 8> half;
  return hn::Add(hn::LowerHalf(half, v), hn::UpperHalf(half, v));
}
#endif

/// Implements add_totals() for four targets at once. The order of the additions, and therefore each
/// bit, is that of hn::SumOfLanes().
template <class Term>
HWY_INLINE void add_totals_at_once(const Terms<float, Term>* group, Index count, std::size_t sum,
                                   Real* sums) {
  static_assert(kTargetGroup == 4);
  const hn::FixedTag<float, 8> d;
  const hn::Repartition<double, decltype(d)> pairs;
  const auto fold_two = [&](std::size_t t) HWY_ATTR {
    const auto a = fold(group[t][0].sums[sum]);
    const auto b = fold(group[t + 1][0].sums[sum]);
    return hn::BitCast(pairs,
                       hn::Add(hn::ConcatLowerLower(d, b, a), hn::ConcatUpperUpper(d, b, a)));
  };
  const auto first = fold_two(0);   // lanes of targets 0 and 1
  const auto second = fold_two(2);  // lanes of targets 2 and 3
  const auto two = hn::Add(hn::BitCast(d, hn::InterleaveLower(pairs, first, second)),
                           hn::BitCast(d, hn::InterleaveUpper(pairs, first, second)));
  alignas(32) float totals[8];  // of targets 0, 2, 1 and 3, each twice
  hn::Store(hn::Add(two, hn::Shuffle2301(two)), d, totals);
  constexpr std::array<std::size_t, kTargetGroup> kLanes = {0, 4, 2, 6};
  for (Index t = 0; t < count; ++t) {
    sums[Term::kSums * t + sum] += static_cast<Real>(totals[kLanes[t]]);
  }
}

#endif

/// Adds the totals over all lanes of the sum with index `sum` to the sums of `count` targets.
template <class T, class Term>
HWY_INLINE void add_totals(const Terms<T, Term>* group, Index count, std::size_t sum, Real* sums) {
#if HWY_TARGET <= HWY_AVX2
  if constexpr (sizeof(T) == 4) return add_totals_at_once<Term>(group, count, sum, sums);
#endif
  const typename Simd<T>::D d;
  for (Index t = 0; t < count; ++t) {
    Real& out = sums[Term::kSums * t + sum];
    if constexpr (sizeof(T) * Simd<T>::kCount > 16) {
      out += static_cast<Real>(hn::GetLane(hn::SumOfLanes(d, group[t][0].sums[sum])));
      continue;
    }
    alignas(16) T lanes[16 / sizeof(T)];
    for (std::size_t k = 0; k < kTerms<T>; ++k) {
      hn::Store(group[t][k].sums[sum], d, lanes + k * Simd<T>::kCount);
    }
    if constexpr (sizeof(T) == 8) {
      out += static_cast<Real>(lanes[0] + lanes[1]);
    } else {
      out += static_cast<Real>((lanes[0] + lanes[2]) + (lanes[1] + lanes[3]));
    }
  }
}

/// Returns the terms of one target for the candidates of a tile.
template <class T, class Term>
HWY_INLINE Terms<T, Term> sum_tile(const Target<T>& target, const Tile<T>& tile,
                                   std::size_t count) {
  Terms<T, Term> terms;
  for (Term& term : terms) {
    for (auto& sum : term.sums) sum = Simd<T>::set(0);
  }
  for (std::size_t k = 0; k < count;) {
    for (Term& term : terms) {
      term.add(target, tile, k);
      k += Simd<T>::kCount;
    }
  }
  return terms;
}

/// Adds the sums over the candidates [first, end) of the cluster to `sums`. `first` and `end` must
/// be multiples of kBatch.
template <class T, class Term>
void add_candidates(const PairInputs& in, const TargetCluster& cluster, std::size_t first,
                    std::size_t end, Tile<T>& tile, Real* sums) {
  const Frame<T> frame(cluster, in);
  const Index* const candidates = in.candidates + cluster.first_candidate;
  Terms<T, Term> group[kTargetGroup] = {};
  for (std::size_t done = first; done < end; done += kTile) {
    const std::size_t count = std::min<std::size_t>(kTile, end - done);
    fill_tile<Term::kParts>(in, frame, candidates + done, count, tile);
    for (Index i = cluster.begin; i < cluster.end; i += kTargetGroup) {
      const Index targets = std::min(kTargetGroup, cluster.end - i);
      for (Index t = 0; t < targets; ++t) {
        Target<T> target =
            load_target < Term::kParts.velocity || Term::kParts.pressure > (in, frame, i + t);
        target.viscosity = Simd<T>::set(in.target_viscosities == nullptr
                                            ? in.viscosity
                                            : in.target_viscosities[i + t - in.first_target]);
        if constexpr (Term::kParts.image_share) {
          if (in.images_decide) target.pressure = Simd<T>::set(0);
        }
        group[t] = sum_tile<T, Term>(target, tile, count);
      }
      Real* const out = sums + Term::kSums * (i - cluster.begin);
      for (std::size_t s = 0; s < Term::kSums; ++s) add_totals<T, Term>(group, targets, s, out);
    }
  }
}

/// Writes the sums over the candidates of the cluster from index `first` to `sums`. `first` must be
/// a multiple of kBatch.
template <class T, class Term>
void sum_cluster(const PairInputs& in, const TargetCluster& cluster, Tile<T>& tile, Real* sums,
                 std::size_t first = 0) {
  std::fill_n(sums, Term::kSums * cluster.size(), Real{0});
  add_candidates<T, Term>(in, cluster, first, cluster.candidate_count, tile, sums);
}

/// Returns the multiple of kBatch at or before the first image of liquid in a wall.
inline std::size_t batch_of_images(const TargetCluster& cluster) {
  return cluster.mirrored_begin - cluster.mirrored_begin % kBatch;
}

/// Writes the forces on the targets of a cluster near walls whose images drag.
template <class T, class Kernel>
void sum_forces_near_walls(const PairInputs& in, const TargetCluster& cluster, Tile<T>& tile,
                           Real* sums) {
  const std::size_t images = batch_of_images(cluster);
  const Index* const candidates = in.candidates + cluster.first_candidate;
  std::fill_n(sums, 3 * cluster.size(), Real{0});
  if (images > 0 && candidates[images - 1] >= in.first_mirrored) {
    using Term = ForceTerm<T, Kernel, Viscosity::not_of_images>;
    add_candidates<T, Term>(in, cluster, 0, images, tile, sums);
  } else {
    using Term = ForceTerm<T, Kernel, Viscosity::same>;
    add_candidates<T, Term>(in, cluster, 0, images, tile, sums);
  }
  using Term = ForceAndDragTerm<T, Kernel>;
  add_candidates<T, Term>(in, cluster, images, cluster.candidate_count, tile, sums);
}

template <class T, class Term>
void sum_clusters(const PairInputs& in, std::span<const TargetCluster> clusters, Real* sums) {
  Tile<T> tile;
  for (const TargetCluster& cluster : clusters) {
    sum_cluster<T, Term>(in, cluster, tile, sums + Term::kSums * (cluster.begin - in.first_target));
  }
}

template <class T, class Kernel>
void sum_forces(const PairInputs& in, std::span<const TargetCluster> clusters, Real* sums) {
  Tile<T> tile;
  const bool drags = in.first_dragging < std::numeric_limits<Index>::max();
  for (const TargetCluster& cluster : clusters) {
    Real* const out = sums + 3 * (cluster.begin - in.first_target);
    if (in.viscosities != nullptr) {
      sum_cluster<T, ForceTerm<T, Kernel, Viscosity::differs>>(in, cluster, tile, out);
    } else if (cluster.has_mirrored && drags) {
      sum_forces_near_walls<T, Kernel>(in, cluster, tile, out);
    } else if (cluster.has_mirrored) {
      sum_cluster<T, ForceTerm<T, Kernel, Viscosity::not_of_images>>(in, cluster, tile, out);
    } else {
      sum_cluster<T, ForceTerm<T, Kernel, Viscosity::same>>(in, cluster, tile, out);
    }
  }
}

template <class T, class Kernel>
void sum_drags(const PairInputs& in, std::span<const TargetCluster> clusters, Real* sums) {
  Tile<T> tile;
  for (const TargetCluster& cluster : clusters) {
    Real* const out = sums + 3 * (cluster.begin - in.first_target);
    const std::size_t first = batch_of_images(cluster);
    if (in.viscosities != nullptr) {
      sum_cluster<T, DragTerm<T, Kernel, true>>(in, cluster, tile, out, first);
    } else {
      sum_cluster<T, DragTerm<T, Kernel, false>>(in, cluster, tile, out, first);
    }
  }
}

template <class T>
struct Loops {
  template <class Kernel>
  static const PairSums& table() {
    static constexpr PairSums kTable{
        &sum_clusters<T, DensityTerm<T, Kernel>>,
        &sum_clusters<T, ForceTerm<T, Kernel, Viscosity::none>>,
        &sum_forces<T, Kernel>,
        &sum_drags<T, Kernel>,
        &sum_clusters<T, GradientTerm<T, Kernel>>,
        &sum_clusters<T, DivergenceTerm<T, Kernel>>,
        &sum_clusters<T, VolumeTerm<T, Kernel>>,
        &sum_clusters<T, ResponseTerm<T, Kernel>>,
        &sum_clusters<T, MeanTerm<T, Kernel>>,
        &sum_clusters<T, BlendTerm<T, Kernel>>,
        &sum_clusters<T, SpreadTerm<T, Kernel>>,
    };
    return kTable;
  }
  static const PairSums& table(KernelId kernel) {
    return kernel == KernelId::cubic_spline ? table<CubicSpline>() : table<Wendland>();
  }
};

#if HWY_TARGET == HWY_AVX2
/// Writes the lanes of `values` whose bit in the mask is set to `found`, and undefined numbers to
/// the next lanes. Returns the number of set bits. With this target, hn::Compress() copies its
/// table to the stack in each call (Highway 1.0.3, g++ 12).
template <class V, class Mask>
HWY_INLINE std::size_t store_selected(V values, Mask mask, Index* found) {
  const hn::ScalableTag<std::uint32_t> u;
  std::uint8_t bits = 0;
  hn::StoreMaskBits(u, mask, &bits);
  const hn::Rebind<std::uint8_t, decltype(u)> bytes;
  const auto lanes = hn::PromoteTo(u, hn::LoadU(bytes, kSelectedLanes[bits].data()));
  hn::StoreU(hn::TableLookupLanes(values, hn::IndicesFromVec(u, lanes)), u, found);
  return static_cast<std::size_t>(std::popcount(bits));
}
#else
template <class V, class Mask>
HWY_INLINE std::size_t store_selected(V values, Mask mask, Index* found) {
  const hn::ScalableTag<std::uint32_t> u;
  // A store of all lanes, because a compressing store to memory is microcoded on AMD's Zen 4.
  hn::StoreU(hn::Compress(values, mask), u, found);
  return hn::CountTrue(u, mask);
}
#endif

std::size_t cull(const CullSlots& slots, Index begin, Index end, const CullBox& box, Index* found,
                 std::size_t count) {
  const hn::ScalableTag<float> d;
  const hn::ScalableTag<std::uint32_t> u;
  using V = hn::Vec<decltype(d)>;
  const std::size_t lanes = hn::Lanes(d);
  const V reach2 = hn::Set(d, box.reach * box.reach);
  const V low_x = hn::Set(d, box.low[0]);
  const V low_y = hn::Set(d, box.low[1]);
  const V low_z = hn::Set(d, box.low[2]);
  const V high_x = hn::Set(d, box.high[0]);
  const V high_y = hn::Set(d, box.high[1]);
  const V high_z = hn::Set(d, box.high[2]);
  const auto beyond = [d](V p, V low, V high) HWY_ATTR {
    return hn::Max(hn::Max(hn::Sub(low, p), hn::Sub(p, high)), hn::Zero(d));
  };
  const float* const x = slots.x;
  const float* const y = slots.y;
  const float* const z = slots.z;
  auto sources = hn::Add(hn::Iota(u, 0), hn::Set(u, slots.first_source + begin));
  const auto next = hn::Set(u, static_cast<std::uint32_t>(lanes));
  for (std::size_t k = begin; k < end; k += lanes) {
    const V dx = beyond(hn::LoadU(d, x + k), low_x, high_x);
    const V dy = beyond(hn::LoadU(d, y + k), low_y, high_y);
    const V dz = beyond(hn::LoadU(d, z + k), low_z, high_z);
    const V square = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    auto is_near = hn::Lt(square, reach2);
    if (end - k < lanes) is_near = hn::And(is_near, hn::FirstN(d, end - k));
    count += store_selected(sources, hn::RebindMask(u, is_near), found + count);
    sources = hn::Add(sources, next);
  }
  return count;
}

}  // namespace

}  // namespace vat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
