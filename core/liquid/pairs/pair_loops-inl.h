// The loops of PairSums for one instruction set. Included once for each of them, hence no guard but
// this one of Highway's.
#if defined(VAT_PAIR_LOOPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VAT_PAIR_LOOPS_INL_H
#undef VAT_PAIR_LOOPS_INL_H
#else
#define VAT_PAIR_LOOPS_INL_H
#endif

#include <hwy/highway.h>

#include "core/liquid/pairs/pair_sums.h"
#include "core/liquid/pairs/pair_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vat::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr Real kSoftening = 0.01 / 4;  // (h/2)^2 / 100 over the support radius h squared

/// The kernels' polynomials; V: a vector, q <= 1. Of the cubic spline g is w' / q over -6.
struct Wendland {
  template <class D, class V>
  static HWY_INLINE V value(D d, V q) {
    const V rest = hn::Sub(hn::Set(d, 1), q);
    const V rest2 = hn::Mul(rest, rest);
    return hn::Mul(hn::Mul(rest2, rest2), hn::MulAdd(hn::Set(d, 4), q, hn::Set(d, 1)));
  }
  template <class D, class V>
  static HWY_INLINE V slope(D d, V q) {
    const V rest = hn::Sub(hn::Set(d, 1), q);
    return hn::Mul(hn::Mul(rest, rest), rest);
  }
};

struct CubicSpline {
  template <class D, class V>
  static HWY_INLINE V value(D d, V q) {
    const V one = hn::Set(d, 1);
    const V rest = hn::Sub(one, q);
    const V inner = hn::Sub(one, hn::Mul(hn::Mul(hn::Set(d, 6), hn::Mul(q, q)), rest));
    const V outer = hn::Mul(hn::Mul(hn::Set(d, 2), rest), hn::Mul(rest, rest));
    return hn::IfThenElse(hn::Lt(q, half(d)), inner, outer);
  }
  template <class D, class V>
  static HWY_INLINE V slope(D d, V q) {
    const V rest = hn::Sub(hn::Set(d, 1), q);
    const V inner = hn::Sub(hn::Set(d, 2), hn::Mul(hn::Set(d, 3), q));
    // Where q is small the quotient is not used.
    const V outer = hn::Div(hn::Mul(rest, rest), hn::Max(q, half(d)));
    return hn::IfThenElse(hn::Lt(q, half(d)), inner, outer);
  }

 private:
  template <class D>
  static HWY_INLINE hn::VFromD<D> half(D d) {
    return hn::Set(d, static_cast<hn::TFromD<D>>(0.5));
  }
};

/// Vectors of one target and those of `N` sources.
template <class T>
struct Lanes {
  using D = hn::ScalableTag<T>;
  using V = hn::Vec<D>;

  static HWY_INLINE V set(Real value) { return hn::Set(D(), static_cast<T>(value)); }
  static constexpr std::size_t kCount = hn::MaxLanes(D());
};

/// A target's place in the frame, and what it is multiplied with.
template <class T>
struct Target {
  using V = typename Lanes<T>::V;
  V x, y, z, pressure, vx, vy, vz, viscosity;
};

/// From source to target, with q.
template <class T>
struct Offset {
  using V = typename Lanes<T>::V;
  V x, y, z, square, q;
};

template <bool has_motion, class T>
HWY_INLINE Target<T> load_target(const PairInputs& in, const Frame<T>& frame, Index i) {
  const typename Lanes<T>::D d;
  const auto& place = frame.place(in, i);
  Target<T> target;
  target.x = hn::Set(d, frame.coordinate(place.x, 0));
  target.y = hn::Set(d, frame.coordinate(place.y, 1));
  target.z = hn::Set(d, frame.coordinate(place.z, 2));
  if constexpr (has_motion) {
    const auto& motion = frame.motion(in, i);
    target.pressure = hn::Set(d, motion.pressure);
    target.vx = hn::Set(d, motion.vx);
    target.vy = hn::Set(d, motion.vy);
    target.vz = hn::Set(d, motion.vz);
  }
  return target;
}

template <class T>
HWY_INLINE Offset<T> offset_of(const Target<T>& target, const Tile<T>& tile, std::size_t k) {
  const typename Lanes<T>::D d;
  Offset<T> at;
  at.x = hn::Sub(target.x, hn::Load(d, tile.x + k));
  at.y = hn::Sub(target.y, hn::Load(d, tile.y + k));
  at.z = hn::Sub(target.z, hn::Load(d, tile.z + k));
  at.square = hn::MulAdd(at.x, at.x, hn::MulAdd(at.y, at.y, hn::Mul(at.z, at.z)));
  // At 1 all kernels are 0.
  at.q = hn::Min(hn::Sqrt(at.square), hn::Set(d, 1));
  return at;
}

template <class T>
HWY_INLINE typename Lanes<T>::V load(const T* column, std::size_t k) {
  return hn::Load(typename Lanes<T>::D(), column + k);
}

/// v.x with v = v_i - v_j.
template <class T>
HWY_INLINE typename Lanes<T>::V approach(const Target<T>& i, const Tile<T>& tile, std::size_t k,
                                         const Offset<T>& at) {
  return hn::MulAdd(hn::Sub(i.vx, load(tile.vx, k)), at.x,
                    hn::MulAdd(hn::Sub(i.vy, load(tile.vy, k)), at.y,
                               hn::Mul(hn::Sub(i.vz, load(tile.vz, k)), at.z)));
}

/// What the share of a pair's viscosity is divided by, where liquids differ.
template <class T>
HWY_INLINE typename Lanes<T>::V resistance(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
  return hn::MulAdd(i.viscosity, load(tile.own, k), load(tile.resistance, k));
}

/// Adds share x to three sums.
template <class T>
HWY_INLINE void add_along(const Offset<T>& at, typename Lanes<T>::V share,
                          typename Lanes<T>::V* sums) {
  sums[0] = hn::MulAdd(share, at.x, sums[0]);
  sums[1] = hn::MulAdd(share, at.y, sums[1]);
  sums[2] = hn::MulAdd(share, at.z, sums[2]);
}

// A term has the sums of one target, and adds to them a vector of sources.

template <class T, class Kernel>
struct DensityTerm {
  using V = typename Lanes<T>::V;
  static constexpr TileParts kParts{};
  static constexpr std::size_t kSums = 1;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const Offset<T> at = offset_of(i, tile, k);
    sums[0] =
        hn::MulAdd(load(tile.weight, k), Kernel::value(typename Lanes<T>::D(), at.q), sums[0]);
  }
};

enum class Viscosity { none, same, not_of_images, differs };

template <class T, class Kernel, Viscosity viscosity>
struct ForceTerm {
  using V = typename Lanes<T>::V;
  static constexpr TileParts kParts{.velocity = viscosity != Viscosity::none,
                                    .pressure = true,
                                    .share = viscosity == Viscosity::not_of_images,
                                    .viscosity = viscosity == Viscosity::differs};
  static constexpr std::size_t kSums = 3;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const typename Lanes<T>::D d;
    const Offset<T> at = offset_of(i, tile, k);
    V force = hn::Neg(hn::Add(i.pressure, load(tile.pressure, k)));
    if constexpr (viscosity != Viscosity::none) {
      V strength = hn::Mul(i.viscosity, approach(i, tile, k, at));
      V divisor = hn::Add(at.square, Lanes<T>::set(kSoftening));
      if constexpr (viscosity != Viscosity::same) {
        strength = hn::Mul(strength, load(tile.share, k));
      }
      if constexpr (viscosity == Viscosity::differs) {
        divisor = hn::Mul(divisor, resistance(i, tile, k));
      }
      force = hn::Add(force, hn::Div(strength, divisor));
    }
    force = hn::Mul(force, hn::Mul(load(tile.weight, k), Kernel::slope(d, at.q)));
    add_along(at, force, sums);
  }
};

template <class T, class Kernel, bool differs>
struct DragTerm {
  using V = typename Lanes<T>::V;
  static constexpr TileParts kParts{
      .velocity = true, .pressure = true, .image_share = !differs, .viscosity = differs};
  static constexpr std::size_t kSums = 3;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const typename Lanes<T>::D d;
    const Offset<T> at = offset_of(i, tile, k);
    V divisor = hn::Add(at.square, Lanes<T>::set(kSoftening));
    if constexpr (differs) {
      divisor = hn::Mul(divisor, resistance(i, tile, k));
    }
    V strength = hn::Mul(hn::Max(i.pressure, load(tile.pressure, k)), load(tile.share, k));
    strength = hn::Mul(hn::Mul(strength, i.viscosity),
                       hn::Mul(load(tile.weight, k), Kernel::slope(d, at.q)));
    strength = hn::Div(strength, divisor);
    sums[0] = hn::MulAdd(hn::Mul(strength, hn::Mul(at.x, at.x)), hn::Sub(i.vx, load(tile.vx, k)),
                         sums[0]);
    sums[1] = hn::MulAdd(hn::Mul(strength, hn::Mul(at.y, at.y)), hn::Sub(i.vy, load(tile.vy, k)),
                         sums[1]);
    sums[2] = hn::MulAdd(hn::Mul(strength, hn::Mul(at.z, at.z)), hn::Sub(i.vz, load(tile.vz, k)),
                         sums[2]);
  }
};

template <class T, class Kernel>
struct GradientTerm {
  using V = typename Lanes<T>::V;
  static constexpr TileParts kParts{};
  static constexpr std::size_t kSums = 3;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const Offset<T> at = offset_of(i, tile, k);
    add_along(at, hn::Mul(load(tile.weight, k), Kernel::slope(typename Lanes<T>::D(), at.q)), sums);
  }
};

template <class T, class Kernel>
struct DivergenceTerm {
  using V = typename Lanes<T>::V;
  static constexpr TileParts kParts{.velocity = true};
  static constexpr std::size_t kSums = 1;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const Offset<T> at = offset_of(i, tile, k);
    const V along = hn::MulAdd(load(tile.vx, k), at.x,
                               hn::MulAdd(load(tile.vy, k), at.y, hn::Mul(load(tile.vz, k), at.z)));
    sums[0] = hn::MulAdd(Kernel::slope(typename Lanes<T>::D(), at.q), along, sums[0]);
  }
};

template <class T, class Kernel>
struct VolumeTerm {
  using V = typename Lanes<T>::V;
  static constexpr TileParts kParts{};
  static constexpr std::size_t kSums = kVolumeSums;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const typename Lanes<T>::D d;
    const Offset<T> at = offset_of(i, tile, k);
    const V weight = load(tile.weight, k);
    sums[0] = hn::MulAdd(weight, Kernel::value(d, at.q), sums[0]);
    const V slope = Kernel::slope(d, at.q);
    const V gradient = hn::Mul(weight, slope);
    add_along(at, gradient, sums + 1);
    sums[4] = hn::MulAdd(hn::Mul(gradient, slope), hn::Mul(at.q, at.q), sums[4]);
  }
};

template <class T, class Kernel>
struct ResponseTerm {
  using V = typename Lanes<T>::V;
  static constexpr TileParts kParts{.velocity = true, .pressure = true};
  static constexpr std::size_t kSums = kResponseSums;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const Offset<T> at = offset_of(i, tile, k);
    const V slope = Kernel::slope(typename Lanes<T>::D(), at.q);
    const V gradient = hn::Mul(load(tile.weight, k), slope);
    add_along(at, gradient, sums);
    const V length = hn::Mul(slope, at.q);
    sums[3] = hn::MulAdd(hn::Mul(load(tile.weight, k), load(tile.pressure, k)),
                         hn::Mul(length, length), sums[3]);
    sums[4] = hn::MulAdd(hn::Mul(load(tile.weight, k), load(tile.vx, k)), length, sums[4]);
  }
};

template <class T, class Kernel>
struct MeanTerm {
  using V = typename Lanes<T>::V;
  static constexpr TileParts kParts{.velocity = true, .pressure = true};
  static constexpr std::size_t kSums = kMeanSums;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const Offset<T> at = offset_of(i, tile, k);
    const V weight = hn::Mul(load(tile.weight, k), Kernel::value(typename Lanes<T>::D(), at.q));
    add_along(at, hn::Mul(weight, load(tile.vx, k)), sums);
    sums[3] = hn::Add(sums[3], weight);
    sums[4] = hn::MulAdd(weight, load(tile.pressure, k), sums[4]);
  }
};

/// Without vectors, terms stand for the lanes of 16 bytes, so that the sums are the same bits.
template <class T>
inline constexpr std::size_t kTerms = Lanes<T>::kCount == 1 ? 16 / sizeof(T) : 1;

/// Of all lanes of one sum.
template <class T, class Term>
HWY_INLINE Real total(const Term* terms, std::size_t sum) {
  const typename Lanes<T>::D d;
  if constexpr (sizeof(T) * Lanes<T>::kCount > 16) {
    return static_cast<Real>(hn::GetLane(hn::SumOfLanes(d, terms[0].sums[sum])));
  }
  alignas(16) T lanes[16 / sizeof(T)];
  for (std::size_t t = 0; t < kTerms<T>; ++t) {
    hn::Store(terms[t].sums[sum], d, lanes + t * Lanes<T>::kCount);
  }
  if constexpr (sizeof(T) == 8) {
    return static_cast<Real>(lanes[0] + lanes[1]);
  } else {
    return static_cast<Real>((lanes[0] + lanes[2]) + (lanes[1] + lanes[3]));
  }
}

/// Over the cluster's candidates from `first` on, a multiple of the lanes.
template <class T, class Term>
void sum_cluster(const PairInputs& in, const TargetCluster& cluster, Tile<T>& tile, Real* sums,
                 std::size_t first = 0) {
  constexpr std::size_t kLanes = Lanes<T>::kCount;
  const Frame<T> frame(cluster, in);
  const Index* const candidates = in.candidates + cluster.first_candidate;
  std::fill_n(sums, Term::kSums * cluster.size(), Real{0});
  for (std::size_t done = first; done < cluster.candidate_count; done += kTile) {
    const std::size_t count = std::min<std::size_t>(kTile, cluster.candidate_count - done);
    fill_tile<Term::kParts>(in, frame, candidates + done, count, tile);
    for (Index i = cluster.begin; i < cluster.end; ++i) {
      Target<T> target =
          load_target < Term::kParts.velocity || Term::kParts.pressure > (in, frame, i);
      target.viscosity = Lanes<T>::set(in.target_viscosities == nullptr
                                           ? in.viscosity
                                           : in.target_viscosities[i - in.first_target]);
      Term terms[kTerms<T>];
      for (Term& term : terms) {
        for (auto& sum : term.sums) sum = Lanes<T>::set(0);
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
