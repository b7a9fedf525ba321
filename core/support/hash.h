#pragma once

#include <bit>
#include <cstdint>

#include "core/types.h"

namespace vat {

/// FNV-1a hash over 64-bit words instead of bytes, with the published 64-bit offset basis and
/// prime. Values are hashed by their bits, so that -0.0 and 0.0 differ.
class StateHash {
 public:
  void add(std::uint64_t word) {
    value_ ^= word;
    value_ *= 0x100000001b3ULL;
    // The multiplication alone would not propagate high bits to low bits.
    value_ ^= value_ >> 32;
  }
  void add(Real value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) add(v[axis]);
  }
  void add(const Quat& q) {
    add(q.w());
    add(Vec3(q.vec()));
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace vat
