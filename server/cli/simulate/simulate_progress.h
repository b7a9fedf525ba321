#pragma once

#include <chrono>
#include <cstdint>

#include "core/types.h"

namespace vat {

/// Progress bar on stderr. Visible only if stderr is a terminal, and cleared at the end.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `time` is the simulated time [s].
  void show(std::uint64_t step, std::uint64_t total_steps, Real time);
  /// Clears the line for other output.
  void clear() const;

 private:
  bool visible_;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace vat
