#pragma once

#include <chrono>

#include "core/types.h"

namespace vat::bench {

/// Measures the time since its creation.
class Stopwatch {
 public:
  /// Returns this time [s].
  Real seconds() const {
    return std::chrono::duration<Real>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace vat::bench
