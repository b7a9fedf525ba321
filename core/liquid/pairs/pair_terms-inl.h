// The terms of PairSums and the polynomials of kernels, for one instruction set. This file is
// included once for each instruction set, like pair_loops-inl.h.
#if defined(VAT_PAIR_TERMS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VAT_PAIR_TERMS_INL_H
#undef VAT_PAIR_TERMS_INL_H
#else
#define VAT_PAIR_TERMS_INL_H
#endif

#include <hwy/highway.h>

#include "core/liquid/pairs/pair_sums.h"
#include "core/liquid/pairs/pair_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vat::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr Real kSoftening = 0.01 / 4;  // (h/2)^2 / 100, divided by the squared support radius h^2

/// The polynomials of the kernels for a vector of q <= 1: value() returns w, and slope() returns g
/// of PairSums. For the cubic spline, g is w' / q / -6.
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
    // For q < 1/2, the quotient is not used.
    const V outer = hn::Div(hn::Mul(rest, rest), hn::Max(q, half(d)));
    return hn::IfThenElse(hn::Lt(q, half(d)), inner, outer);
  }

 private:
  template <class D>
  static HWY_INLINE hn::VFromD<D> half(D d) {
    return hn::Set(d, static_cast<hn::TFromD<D>>(0.5));
  }
};

/// Vectors of elements of type T.
template <class T>
struct Simd {
  using D = hn::ScalableTag<T>;
  using V = hn::Vec<D>;

  static HWY_INLINE V set(Real value) { return hn::Set(D(), static_cast<T>(value)); }
  static constexpr std::size_t kCount = hn::MaxLanes(D());
};

/// The position of a target relative to the cluster's centre, and the motion and viscosity of the
/// target.
template <class T>
struct Target {
  using V = typename Simd<T>::V;
  V x, y, z, pressure, vx, vy, vz, viscosity;
};

/// The vector from a source to a target, and its length q.
template <class T>
struct Offset {
  using V = typename Simd<T>::V;
  V x, y, z, square, q;
};

template <bool has_motion, class T>
HWY_INLINE Target<T> load_target(const PairInputs& in, const Frame<T>& frame, Index i) {
  const typename Simd<T>::D d;
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
  const typename Simd<T>::D d;
  Offset<T> at;
  at.x = hn::Sub(target.x, hn::Load(d, tile.x + k));
  at.y = hn::Sub(target.y, hn::Load(d, tile.y + k));
  at.z = hn::Sub(target.z, hn::Load(d, tile.z + k));
  at.square = hn::MulAdd(at.x, at.x, hn::MulAdd(at.y, at.y, hn::Mul(at.z, at.z)));
  // At q = 1, all kernels are 0.
  at.q = hn::Min(hn::Sqrt(at.square), hn::Set(d, 1));
  return at;
}

template <class T>
HWY_INLINE typename Simd<T>::V load(const T* column, std::size_t k) {
  return hn::Load(typename Simd<T>::D(), column + k);
}

/// Returns v.x with v = v_i - v_j.
template <class T>
HWY_INLINE typename Simd<T>::V approach(const Target<T>& i, const Tile<T>& tile, std::size_t k,
                                        const Offset<T>& at) {
  return hn::MulAdd(hn::Sub(i.vx, load(tile.vx, k)), at.x,
                    hn::MulAdd(hn::Sub(i.vy, load(tile.vy, k)), at.y,
                               hn::Mul(hn::Sub(i.vz, load(tile.vz, k)), at.z)));
}

/// Returns the divisor of a pair's viscosity for liquids with different viscosities; see
/// PairViscosity.
template <class T>
HWY_INLINE typename Simd<T>::V resistance(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
  return hn::MulAdd(i.viscosity, load(tile.own, k), load(tile.resistance, k));
}

/// Adds share * x to three sums.
template <class T>
HWY_INLINE void add_along(const Offset<T>& at, typename Simd<T>::V share,
                          typename Simd<T>::V* sums) {
  sums[0] = hn::MulAdd(share, at.x, sums[0]);
  sums[1] = hn::MulAdd(share, at.y, sums[1]);
  sums[2] = hn::MulAdd(share, at.z, sums[2]);
}

// A term contains the sums of one target. The function add() adds the contributions of a vector of
// sources.

template <class T, class Kernel>
struct DensityTerm {
  using V = typename Simd<T>::V;
  static constexpr TileColumns kParts{};
  static constexpr std::size_t kSums = 1;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const Offset<T> at = offset_of(i, tile, k);
    sums[0] = hn::MulAdd(load(tile.weight, k), Kernel::value(typename Simd<T>::D(), at.q), sums[0]);
  }
};

enum class Viscosity { none, same, not_of_images, differs };

template <class T, class Kernel, Viscosity viscosity>
struct ForceTerm {
  using V = typename Simd<T>::V;
  static constexpr TileColumns kParts{.velocity = viscosity != Viscosity::none,
                                      .pressure = true,
                                      .share = viscosity == Viscosity::not_of_images,
                                      .viscosity = viscosity == Viscosity::differs};
  static constexpr std::size_t kSums = 3;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const typename Simd<T>::D d;
    const Offset<T> at = offset_of(i, tile, k);
    V force = hn::Neg(hn::Add(i.pressure, load(tile.pressure, k)));
    if constexpr (viscosity != Viscosity::none) {
      V strength = hn::Mul(i.viscosity, approach(i, tile, k, at));
      V divisor = hn::Add(at.square, Simd<T>::set(kSoftening));
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

/// The sum of ForceTerm with Viscosity::not_of_images and DragTerm.
template <class T, class Kernel>
struct ForceAndDragTerm {
  using V = typename Simd<T>::V;
  static constexpr TileColumns kParts{
      .velocity = true, .pressure = true, .share = true, .drag_share = true};
  static constexpr std::size_t kSums = 3;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const typename Simd<T>::D d;
    const Offset<T> at = offset_of(i, tile, k);
    const V weight = hn::Mul(load(tile.weight, k), Kernel::slope(d, at.q));
    const V divisor = hn::Add(at.square, Simd<T>::set(kSoftening));
    const V strength = hn::Div(hn::Mul(i.viscosity, weight), divisor);
    const V x = hn::Mul(hn::Sub(i.vx, load(tile.vx, k)), at.x);
    const V y = hn::Mul(hn::Sub(i.vy, load(tile.vy, k)), at.y);
    const V z = hn::Mul(hn::Sub(i.vz, load(tile.vz, k)), at.z);
    const V central = hn::Mul(hn::Mul(strength, load(tile.share, k)), hn::Add(x, hn::Add(y, z)));
    const V force = hn::NegMulAdd(hn::Add(i.pressure, load(tile.pressure, k)), weight, central);
    const V drag = hn::Mul(strength, load(tile.drag_share, k));
    sums[0] = hn::MulAdd(hn::MulAdd(drag, x, force), at.x, sums[0]);
    sums[1] = hn::MulAdd(hn::MulAdd(drag, y, force), at.y, sums[1]);
    sums[2] = hn::MulAdd(hn::MulAdd(drag, z, force), at.z, sums[2]);
  }
};

template <class T, class Kernel, bool differs>
struct DragTerm {
  using V = typename Simd<T>::V;
  static constexpr TileColumns kParts{
      .velocity = true, .pressure = true, .image_share = !differs, .viscosity = differs};
  static constexpr std::size_t kSums = 3;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const typename Simd<T>::D d;
    const Offset<T> at = offset_of(i, tile, k);
    V divisor = hn::Add(at.square, Simd<T>::set(kSoftening));
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
  using V = typename Simd<T>::V;
  static constexpr TileColumns kParts{};
  static constexpr std::size_t kSums = 3;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const Offset<T> at = offset_of(i, tile, k);
    add_along(at, hn::Mul(load(tile.weight, k), Kernel::slope(typename Simd<T>::D(), at.q)), sums);
  }
};

template <class T, class Kernel>
struct DivergenceTerm {
  using V = typename Simd<T>::V;
  static constexpr TileColumns kParts{.velocity = true};
  static constexpr std::size_t kSums = 1;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const Offset<T> at = offset_of(i, tile, k);
    const V along = hn::MulAdd(load(tile.vx, k), at.x,
                               hn::MulAdd(load(tile.vy, k), at.y, hn::Mul(load(tile.vz, k), at.z)));
    sums[0] = hn::MulAdd(Kernel::slope(typename Simd<T>::D(), at.q), along, sums[0]);
  }
};

template <class T, class Kernel>
struct VolumeTerm {
  using V = typename Simd<T>::V;
  static constexpr TileColumns kParts{};
  static constexpr std::size_t kSums = kVolumeSums;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const typename Simd<T>::D d;
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
  using V = typename Simd<T>::V;
  static constexpr TileColumns kParts{.velocity = true, .pressure = true};
  static constexpr std::size_t kSums = kResponseSums;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const Offset<T> at = offset_of(i, tile, k);
    const V slope = Kernel::slope(typename Simd<T>::D(), at.q);
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
  using V = typename Simd<T>::V;
  static constexpr TileColumns kParts{.velocity = true, .pressure = true};
  static constexpr std::size_t kSums = kMeanSums;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const Offset<T> at = offset_of(i, tile, k);
    const V weight = hn::Mul(load(tile.weight, k), Kernel::value(typename Simd<T>::D(), at.q));
    add_along(at, hn::Mul(weight, load(tile.vx, k)), sums);
    sums[3] = hn::Add(sums[3], weight);
    sums[4] = hn::MulAdd(weight, load(tile.pressure, k), sums[4]);
  }
};

template <class T, class Kernel>
struct BlendTerm {
  using V = typename Simd<T>::V;
  static constexpr TileColumns kParts{.velocity = true};
  static constexpr std::size_t kSums = 3;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const Offset<T> at = offset_of(i, tile, k);
    const V weight = hn::Mul(load(tile.weight, k), Kernel::value(typename Simd<T>::D(), at.q));
    sums[0] = hn::MulAdd(weight, load(tile.vx, k), sums[0]);
    sums[1] = hn::MulAdd(weight, load(tile.vy, k), sums[1]);
    sums[2] = hn::MulAdd(weight, load(tile.vz, k), sums[2]);
  }
};

template <class T, class Kernel>
struct SpreadTerm {
  using V = typename Simd<T>::V;
  static constexpr TileColumns kParts{.velocity = true};
  static constexpr std::size_t kSums = kSpreadSums;
  V sums[kSums];

  HWY_INLINE void add(const Target<T>& i, const Tile<T>& tile, std::size_t k) {
    const typename Simd<T>::D d;
    const Offset<T> at = offset_of(i, tile, k);
    const V weight = load(tile.weight, k);
    sums[0] =
        hn::MulAdd(hn::Mul(weight, Kernel::slope(d, at.q)), approach(i, tile, k, at), sums[0]);
    sums[1] = hn::MulAdd(weight, Kernel::value(d, at.q), sums[1]);
  }
};

}  // namespace

}  // namespace vat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
