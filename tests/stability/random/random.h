#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "core/types.h"

namespace vat::stability {

/// Random numbers that do not depend on the standard library's distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  Real between(Real low, Real high) {
    return low + (high - low) * (static_cast<Real>(engine_() >> 11U) * 0x1p-53);
  }
  /// Returns a number with a uniform logarithm.
  Real scale(Real low, Real high) { return std::exp(between(std::log(low), std::log(high))); }
  int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
  bool chance(Real part) { return between(0, 1) < part; }
  Vec3 vector(Real most) {
    const Real x = between(-most, most);
    const Real y = between(-most, most);
    return {x, y, between(-most, most)};
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace vat::stability
