#include "server/cli/tune/tune_progress.h"

#include <unistd.h>

#include <iostream>

#include "server/cli/simulate/simulate_progress.h"

namespace vat {

TuneProgress::TuneProgress() : visible_(isatty(STDERR_FILENO) == 1) {}

TuneProgress::~TuneProgress() {
  if (visible_) std::cerr << "\r\x1b[K" << std::flush;
}

void TuneProgress::show(const std::string& stage, const tune::Progress& progress) {
  constexpr std::chrono::milliseconds kInterval{100};
  const auto now = std::chrono::steady_clock::now();
  if (!visible_ || now < next_) return;
  next_ = now + kInterval;
  const std::chrono::duration<double> remaining(std::max(0.0, progress.remaining));
  std::cerr << '\r' << stage << ": " << progress.completed << " of " << progress.runs
            << "  remaining: " << duration_text(remaining) << "\x1b[K" << std::flush;
}

}  // namespace vat
