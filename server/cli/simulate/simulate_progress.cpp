#include "server/cli/simulate/simulate_progress.h"

#include <unistd.h>

#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>

namespace vat {

ProgressBar::ProgressBar() : visible_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  clear();
}

void ProgressBar::clear() const {
  if (visible_) std::cerr << "\r\x1b[K" << std::flush;
}

void ProgressBar::show(std::uint64_t step, std::uint64_t total_steps, Real time) {
  constexpr std::size_t kWidth = 40;
  constexpr std::chrono::milliseconds kInterval{100};
  const auto now = std::chrono::steady_clock::now();
  if (!visible_ || total_steps == 0 || now < next_) return;
  next_ = now + kInterval;
  const std::size_t percent = step * 100 / total_steps;
  const std::size_t filled = percent * kWidth / 100;
  std::ostringstream line;
  line << "\r[" << std::string(filled, '#') << std::string(kWidth - filled, ' ') << "] "
       << std::setw(3) << percent << " %  t = " << std::fixed << std::setprecision(2) << time
       << " s\x1b[K";
  std::cerr << line.str() << std::flush;
}

}  // namespace vat
