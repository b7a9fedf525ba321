// Tiles: candidates of a cluster as arrays for vector loads, for one instruction set. This file is
// included once for each instruction set, like pair_loops-inl.h.
#if defined(VAT_PAIR_TILE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VAT_PAIR_TILE_INL_H
#undef VAT_PAIR_TILE_INL_H
#else
#define VAT_PAIR_TILE_INL_H
#endif

#include <hwy/highway.h>

#include "core/liquid/pairs/pair_sums.h"

HWY_BEFORE_NAMESPACE();
namespace vat::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Maximum number of candidates in a tile.
constexpr std::size_t kTile = 512;

/// The arrays of a tile that a loop reads in addition to x, y, z and weight.
struct TileColumns {
  bool velocity = false;
  bool pressure = false;
  bool share = false;        ///< `share` is 0 for images in walls, 1 for others
  bool image_share = false;  ///< `share` is 1 for images in walls, 0 for others
  bool drag_share = false;   ///< `drag_share` is 1 for sources that drag, 0 for others
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
  alignas(64) T drag_share[kTile];
  alignas(64) T own[kTile];
  alignas(64) T resistance[kTile];
};

/// A converter to coordinates relative to a cluster's centre, in units of the support radius.
template <class T>
struct Frame;

template <>
struct Frame<double> {
  Real center[3];
  Real scale;

  Frame(const TargetCluster& cluster, const PairInputs& in)
      : center{cluster.center.x(), cluster.center.y(), cluster.center.z()},
        scale(in.inverse_support) {}

  static const PairPlace& place(const PairInputs& in, Index n) { return in.places[n]; }
  static const PairMotion& motion(const PairInputs& in, Index n) { return in.motions[n]; }
  double coordinate(Real x, int axis) const { return (x - center[axis]) * scale; }
};

template <>
struct Frame<float> {
  std::int32_t center[3];
  float scale;

  Frame(const TargetCluster& cluster, const PairInputs& in)
      : center{in.grid.coordinate(cluster.center.x(), 0), in.grid.coordinate(cluster.center.y(), 1),
               in.grid.coordinate(cluster.center.z(), 2)},
        scale(static_cast<float>(in.grid.unit * in.inverse_support)) {}

  static const PackedPlace& place(const PairInputs& in, Index n) { return in.packed_places[n]; }
  static const PackedMotion& motion(const PairInputs& in, Index n) { return in.packed_motions[n]; }
  float coordinate(std::int32_t x, int axis) const {
    return static_cast<float>(x - center[axis]) * scale;
  }
};

template <TileColumns parts, class T>
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
  if constexpr (parts.drag_share) {
    for (std::size_t k = 0; k < count; ++k) {
      tile.drag_share[k] = static_cast<T>(candidates[k] >= in.first_dragging);
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

template <TileColumns parts, class T>
HWY_INLINE void fill_tile(const PairInputs& in, const Frame<T>& frame, const Index* candidates,
                          std::size_t count, Tile<T>& tile) {
  for (std::size_t k = 0; k < count; ++k) {
    const auto& place = frame.place(in, candidates[k]);
    tile.x[k] = frame.coordinate(place.x, 0);
    tile.y[k] = frame.coordinate(place.y, 1);
    tile.z[k] = frame.coordinate(place.z, 2);
    tile.weight[k] = place.weight;
    if constexpr (parts.pressure) tile.pressure[k] = frame.motion(in, candidates[k]).pressure;
    if constexpr (parts.velocity) {
      const auto& motion = frame.motion(in, candidates[k]);
      tile.vx[k] = motion.vx;
      tile.vy[k] = motion.vy;
      tile.vz[k] = motion.vz;
    }
  }
  fill_viscosity<parts>(in, candidates, count, tile);
}

#if HWY_TARGET != HWY_SCALAR

using Floats = hn::ScalableTag<float>;
using FloatVec = hn::Vec<Floats>;

/// Loads the records of candidates[0], candidates[4], ..., of 16 bytes each.
template <std::size_t lanes, class Record>
HWY_INLINE auto load_records(const Record* records, const Index* candidates) {
  const hn::FixedTag<float, lanes> d;
  if constexpr (lanes == 4) {
    return hn::Load(d, reinterpret_cast<const float*>(records + candidates[0]));
  } else {
    return hn::Combine(d, load_records<lanes / 2>(records, candidates + lanes / 2),
                       load_records<lanes / 2>(records, candidates));
  }
}

/// The four members of one record per lane, with one vector for each member.
struct Columns {
  FloatVec a, b, c, e;
};
template <class Record>
HWY_INLINE Columns load_columns(const Record* records, const Index* candidates) {
  constexpr std::size_t kLanes = hn::MaxLanes(Floats());
  const Floats d;
  const hn::Repartition<double, Floats> pairs;
  const FloatVec r0 = load_records<kLanes>(records, candidates);
  const FloatVec r1 = load_records<kLanes>(records, candidates + 1);
  const FloatVec r2 = load_records<kLanes>(records, candidates + 2);
  const FloatVec r3 = load_records<kLanes>(records, candidates + 3);
  const auto low01 = hn::BitCast(pairs, hn::InterleaveLower(d, r0, r1));
  const auto high01 = hn::BitCast(pairs, hn::InterleaveUpper(d, r0, r1));
  const auto low23 = hn::BitCast(pairs, hn::InterleaveLower(d, r2, r3));
  const auto high23 = hn::BitCast(pairs, hn::InterleaveUpper(d, r2, r3));
  return {hn::BitCast(d, hn::InterleaveLower(pairs, low01, low23)),
          hn::BitCast(d, hn::InterleaveUpper(pairs, low01, low23)),
          hn::BitCast(d, hn::InterleaveLower(pairs, high01, high23)),
          hn::BitCast(d, hn::InterleaveUpper(pairs, high01, high23))};
}

/// Vectorised version of fill_tile(). `count` must be a multiple of the number of lanes.
template <TileColumns parts>
HWY_INLINE void fill_tile(const PairInputs& in, const Frame<float>& frame, const Index* candidates,
                          std::size_t count, Tile<float>& tile) {
  const Floats d;
  const hn::RebindToSigned<Floats> i;
  const auto cx = hn::Set(i, frame.center[0]);
  const auto cy = hn::Set(i, frame.center[1]);
  const auto cz = hn::Set(i, frame.center[2]);
  const FloatVec scale = hn::Set(d, frame.scale);
  const auto coordinate = [&](FloatVec column, auto center) HWY_ATTR {
    return hn::Mul(hn::ConvertTo(d, hn::Sub(hn::BitCast(i, column), center)), scale);
  };
  for (std::size_t k = 0; k < count; k += hn::MaxLanes(d)) {
    const Columns place = load_columns(in.packed_places, candidates + k);
    hn::Store(coordinate(place.a, cx), d, tile.x + k);
    hn::Store(coordinate(place.b, cy), d, tile.y + k);
    hn::Store(coordinate(place.c, cz), d, tile.z + k);
    hn::Store(place.e, d, tile.weight + k);
    if constexpr (parts.pressure || parts.velocity) {
      const Columns motion = load_columns(in.packed_motions, candidates + k);
      if constexpr (parts.pressure) hn::Store(motion.a, d, tile.pressure + k);
      if constexpr (parts.velocity) {
        hn::Store(motion.b, d, tile.vx + k);
        hn::Store(motion.c, d, tile.vy + k);
        hn::Store(motion.e, d, tile.vz + k);
      }
    }
  }
  fill_viscosity<parts>(in, candidates, count, tile);
}

#endif

}  // namespace

}  // namespace vat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
