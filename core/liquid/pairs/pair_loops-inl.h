// The loops of PairSums for one instruction set. This file is included once for each instruction
// set, which requires the toggling include guard of Highway.
#if defined(VAT_PAIR_LOOPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VAT_PAIR_LOOPS_INL_H
#undef VAT_PAIR_LOOPS_INL_H
#else
#define VAT_PAIR_LOOPS_INL_H
#endif

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

/// Returns the total over all lanes of the sum with index `sum`.
template <class T, class Term>
HWY_INLINE Real total(const Term* terms, std::size_t sum) {
  const typename Simd<T>::D d;
  if constexpr (sizeof(T) * Simd<T>::kCount > 16) {
    return static_cast<Real>(hn::GetLane(hn::SumOfLanes(d, terms[0].sums[sum])));
  }
  alignas(16) T lanes[16 / sizeof(T)];
  for (std::size_t t = 0; t < kTerms<T>; ++t) {
    hn::Store(terms[t].sums[sum], d, lanes + t * Simd<T>::kCount);
  }
  if constexpr (sizeof(T) == 8) {
    return static_cast<Real>(lanes[0] + lanes[1]);
  } else {
    return static_cast<Real>((lanes[0] + lanes[2]) + (lanes[1] + lanes[3]));
  }
}

/// Sums over the candidates of the cluster from index `first`. Writes the result to `sums`. `first`
/// must be a multiple of the number of lanes.
template <class T, class Term>
void sum_cluster(const PairInputs& in, const TargetCluster& cluster, Tile<T>& tile, Real* sums,
                 std::size_t first = 0) {
  constexpr std::size_t kLanes = Simd<T>::kCount;
  const Frame<T> frame(cluster, in);
  const Index* const candidates = in.candidates + cluster.first_candidate;
  std::fill_n(sums, Term::kSums * cluster.size(), Real{0});
  for (std::size_t done = first; done < cluster.candidate_count; done += kTile) {
    const std::size_t count = std::min<std::size_t>(kTile, cluster.candidate_count - done);
    fill_tile<Term::kParts>(in, frame, candidates + done, count, tile);
    for (Index i = cluster.begin; i < cluster.end; ++i) {
      Target<T> target =
          load_target < Term::kParts.velocity || Term::kParts.pressure > (in, frame, i);
      target.viscosity = Simd<T>::set(in.target_viscosities == nullptr
                                          ? in.viscosity
                                          : in.target_viscosities[i - in.first_target]);
      Term terms[kTerms<T>];
      for (Term& term : terms) {
        for (auto& sum : term.sums) sum = Simd<T>::set(0);
      }
      for (std::size_t k = 0; k < count;) {
        for (std::size_t t = 0; t < kTerms<T>; ++t, k += kLanes) terms[t].add(target, tile, k);
      }
      Real* const out = sums + Term::kSums * (i - cluster.begin);
      for (std::size_t s = 0; s < Term::kSums; ++s) out[s] += total<T>(terms, s);
    }
  }
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
  for (const TargetCluster& cluster : clusters) {
    Real* const out = sums + 3 * (cluster.begin - in.first_target);
    if (in.viscosities != nullptr) {
      sum_cluster<T, ForceTerm<T, Kernel, Viscosity::differs>>(in, cluster, tile, out);
    } else if (cluster.has_mirrored) {
      sum_cluster<T, ForceTerm<T, Kernel, Viscosity::not_of_images>>(in, cluster, tile, out);
    } else {
      sum_cluster<T, ForceTerm<T, Kernel, Viscosity::same>>(in, cluster, tile, out);
    }
  }
}

template <class T, class Kernel>
void sum_drags(const PairInputs& in, std::span<const TargetCluster> clusters, Real* sums) {
  constexpr std::size_t kLanes = hn::MaxLanes(hn::ScalableTag<float>());
  Tile<T> tile;
  for (const TargetCluster& cluster : clusters) {
    Real* const out = sums + 3 * (cluster.begin - in.first_target);
    const std::size_t first = cluster.mirrored_begin - cluster.mirrored_begin % kLanes;
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
    };
    return kTable;
  }
  static const PairSums& table(KernelId kernel) {
    return kernel == KernelId::cubic_spline ? table<CubicSpline>() : table<Wendland>();
  }
};

std::size_t cull(const CullSlots& slots, Index begin, Index end, const CullBox& box, Index* found,
                 std::size_t count) {
  const hn::ScalableTag<float> d;
  const hn::ScalableTag<std::uint32_t> u;
  using V = hn::Vec<decltype(d)>;
  const std::size_t lanes = hn::Lanes(d);
  const V reach2 = hn::Set(d, box.reach * box.reach);
  const auto beyond = [&](const float* column, std::size_t k, int axis) HWY_ATTR {
    const V p = hn::LoadU(d, column + k);
    const V below = hn::Sub(hn::Set(d, box.low[axis]), p);
    const V above = hn::Sub(p, hn::Set(d, box.high[axis]));
    return hn::Max(hn::Max(below, above), hn::Zero(d));
  };
  for (std::size_t k = begin; k < end; k += lanes) {
    const V dx = beyond(slots.x, k, 0);
    const V dy = beyond(slots.y, k, 1);
    const V dz = beyond(slots.z, k, 2);
    const V square = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    auto is_near = hn::Lt(square, reach2);
    if (end - k < lanes) is_near = hn::And(is_near, hn::FirstN(d, end - k));
    const auto sources =
        hn::Iota(u, static_cast<std::uint32_t>(slots.first_source + static_cast<Index>(k)));
    count += hn::CompressStore(sources, hn::RebindMask(u, is_near), u, found + count);
  }
  return count;
}

}  // namespace

}  // namespace vat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
