#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>

#include "server/support/limit_excess.h"

namespace vat {

/// Returns the memory of the process: its pages in memory and in the swap space [bytes].
std::size_t process_memory();

/// Limit of the memory of the process. Thread-safe.
class MemoryLimit {
 public:
  using Measure = std::function<std::size_t()>;
  /// `maximum` is in bytes; 0: no limit. `measure` returns the memory and must be thread-safe.
  MemoryLimit(std::size_t maximum, Measure measure)
      : maximum_(maximum), measure_(std::move(measure)) {}

  /// Returns the limit if the process uses more.
  std::optional<LimitExcess> find_excess() const {
    if (maximum_ == 0 || measure_() <= maximum_) return {};
    return LimitExcess{"memory_bytes", maximum_};
  }
  std::size_t used() const { return measure_(); }

 private:
  const std::size_t maximum_;
  const Measure measure_;
};

}  // namespace vat
