// The candidates of a cluster as columns that vectors load, for one instruction set: included once
// for each of them, like pair_loops-inl.h.
#if defined(VAT_PAIR_TILE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VAT_PAIR_TILE_INL_H
#undef VAT_PAIR_TILE_INL_H
#else
#define VAT_PAIR_TILE_INL_H
#endif

#include <hwy/highway.h>

#include "core/pairs/pair_sums.h"

HWY_BEFORE_NAMESPACE();
namespace vat::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Candidates of a cluster, a part at a time, about its centre and over the support radius.
constexpr std::size_t kTile = 512;

/// The columns of a tile that a loop reads besides x, y, z and weight.
struct TileParts {
  bool motion = false;
  bool share = false;        ///< 0 of images, 1 of others
  bool image_share = false;  ///< 1 of images, 0 of others
  bool viscosity = false;
};

template <class T>
struct Tile {
  alignas(64) T x[kTile];
  alignas(64) T y[kTile];
  alignas(64) T z[kTile];
  alignas(64) T weight[kTile];
  alignas(64) T pressure[kTile];
  alignas(64) T vx[kTile];
  alignas(64) T vy[kTile];
  alignas(64) T vz[kTile];
  alignas(64) T share[kTile];
  alignas(64) T own[kTile];
  alignas(64) T resistance[kTile];
};

/// About a cluster's centre, over the support radius.
struct Frame {
  alignas(32) Real center[4];
  alignas(32) Real scale[4];

  Frame(const TargetCluster& cluster, Real inverse_support)
      : center{cluster.center.x(), cluster.center.y(), cluster.center.z(), 0},
        scale{inverse_support, inverse_support, inverse_support, 1} {}
};

template <TileParts parts, class T>
HWY_INLINE void fill_viscosity(const PairInputs& in, const Index* candidates, std::size_t count,
                               Tile<T>& tile) {
  if constexpr (parts.share) {
    for (std::size_t k = 0; k < count; ++k) {
      tile.share[k] = static_cast<T>(candidates[k] < in.first_mirrored);
    }
  }
  if constexpr (parts.image_share) {
    for (std::size_t k = 0; k < count; ++k) {
      tile.share[k] = static_cast<T>(candidates[k] >= in.first_mirrored);
    }
  }
  if constexpr (parts.viscosity) {
    for (std::size_t k = 0; k < count; ++k) {
      const PairViscosity& viscosity = in.viscosities[candidates[k]];
      tile.share[k] = static_cast<T>(viscosity.share);
      tile.own[k] = static_cast<T>(viscosity.own);
      tile.resistance[k] = static_cast<T>(viscosity.resistance);
    }
  }
}

template <TileParts parts, class T>
HWY_INLINE void fill_tile(const PairInputs& in, const Frame& frame, const Index* candidates,
                          std::size_t count, Tile<T>& tile) {
  for (std::size_t k = 0; k < count; ++k) {
    const PairPlace& place = in.places[candidates[k]];
    tile.x[k] = static_cast<T>((place.x - frame.center[0]) * frame.scale[0]);
    tile.y[k] = static_cast<T>((place.y - frame.center[1]) * frame.scale[1]);
    tile.z[k] = static_cast<T>((place.z - frame.center[2]) * frame.scale[2]);
    tile.weight[k] = static_cast<T>(place.weight);
    if constexpr (parts.motion) {
      const PairMotion& motion = in.motions[candidates[k]];
      tile.pressure[k] = static_cast<T>(motion.pressure);
      tile.vx[k] = static_cast<T>(motion.vx);
      tile.vy[k] = static_cast<T>(motion.vy);
      tile.vz[k] = static_cast<T>(motion.vz);
    }
  }
  fill_viscosity<parts>(in, candidates, count, tile);
}

#if HWY_TARGET != HWY_SCALAR

/// (record - center) * scale of four numbers, in single precision.
HWY_INLINE hn::Vec128<float> to_single(const Real* record, const Real* center, const Real* scale) {
#if HWY_TARGET <= HWY_AVX2 && HWY_ARCH_X86
  const hn::FixedTag<double, 4> d;
  const hn::FixedTag<float, 4> f;
  return hn::DemoteTo(
      f, hn::Mul(hn::Sub(hn::Load(d, record), hn::Load(d, center)), hn::Load(d, scale)));
#else
  const hn::FixedTag<double, 2> d;
  const hn::FixedTag<float, 2> f;
  const hn::FixedTag<float, 4> whole;
  const auto low = hn::Mul(hn::Sub(hn::Load(d, record), hn::Load(d, center)), hn::Load(d, scale));
  const auto high =
      hn::Mul(hn::Sub(hn::Load(d, record + 2), hn::Load(d, center + 2)), hn::Load(d, scale + 2));
  return hn::Combine(whole, hn::DemoteTo(f, high), hn::DemoteTo(f, low));
#endif
}

HWY_INLINE hn::Vec128<float> to_single(const Real* record) {
#if HWY_TARGET <= HWY_AVX2 && HWY_ARCH_X86
  const hn::FixedTag<double, 4> d;
  return hn::DemoteTo(hn::FixedTag<float, 4>(), hn::Load(d, record));
#else
  const hn::FixedTag<double, 2> d;
  const hn::FixedTag<float, 2> f;
  return hn::Combine(hn::FixedTag<float, 4>(), hn::DemoteTo(f, hn::Load(d, record + 2)),
                     hn::DemoteTo(f, hn::Load(d, record)));
#endif
}

/// The columns of four records.
HWY_INLINE void store_columns(hn::Vec128<float> a, hn::Vec128<float> b, hn::Vec128<float> c,
                              hn::Vec128<float> e, float* x, float* y, float* z, float* w) {
  const hn::FixedTag<float, 4> f;
  const auto ab_low = hn::InterleaveLower(f, a, b);
  const auto ab_high = hn::InterleaveUpper(f, a, b);
  const auto ce_low = hn::InterleaveLower(f, c, e);
  const auto ce_high = hn::InterleaveUpper(f, c, e);
  const hn::FixedTag<double, 2> pairs;
  const auto lower = [&](hn::Vec128<float> p, hn::Vec128<float> q) HWY_ATTR {
    return hn::BitCast(f, hn::InterleaveLower(pairs, hn::BitCast(pairs, p), hn::BitCast(pairs, q)));
  };
  const auto upper = [&](hn::Vec128<float> p, hn::Vec128<float> q) HWY_ATTR {
    return hn::BitCast(f, hn::InterleaveUpper(pairs, hn::BitCast(pairs, p), hn::BitCast(pairs, q)));
  };
  hn::Store(lower(ab_low, ce_low), f, x);
  hn::Store(upper(ab_low, ce_low), f, y);
  hn::Store(lower(ab_high, ce_high), f, z);
  hn::Store(upper(ab_high, ce_high), f, w);
}

/// `count`: a multiple of 4.
template <TileParts parts>
HWY_INLINE void fill_tile(const PairInputs& in, const Frame& frame, const Index* candidates,
                          std::size_t count, Tile<float>& tile) {
  const auto place = [&](std::size_t k) HWY_ATTR {
    return to_single(&in.places[candidates[k]].x, frame.center, frame.scale);
  };
  const auto motion = [&](std::size_t k)
                          HWY_ATTR { return to_single(&in.motions[candidates[k]].pressure); };
  for (std::size_t k = 0; k < count; k += 4) {
    store_columns(place(k), place(k + 1), place(k + 2), place(k + 3), tile.x + k, tile.y + k,
                  tile.z + k, tile.weight + k);
    if constexpr (parts.motion) {
      store_columns(motion(k), motion(k + 1), motion(k + 2), motion(k + 3), tile.pressure + k,
                    tile.vx + k, tile.vy + k, tile.vz + k);
    }
  }
  fill_viscosity<parts>(in, candidates, count, tile);
}

#endif

}  // namespace

}  // namespace vat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
