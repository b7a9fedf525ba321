#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "core/types.h"

namespace vat {

/// Returns a duration for people: "12 s", "3 min 20 s" or "2 h 5 min". The duration is at least 0.
std::string duration_text(std::chrono::duration<double> duration);

/// Progress bar on stderr, with an estimate of the remaining time. Visible only if stderr is a
/// terminal, and cleared at the end.
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
  std::chrono::steady_clock::time_point begin_;
  std::optional<std::uint64_t> begin_step_;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace vat
