#include "server/cli/simulate/simulate_progress.h"

#include <unistd.h>

#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>

namespace vat {

std::string duration_text(std::chrono::duration<double> duration) {
  constexpr std::uint64_t kMinute = 60;
  constexpr std::uint64_t kHour = 60 * kMinute;
  const auto seconds = static_cast<std::uint64_t>(std::ceil(duration.count()));
  if (seconds < kMinute) return std::to_string(seconds) + " s";
  if (seconds < kHour) {
    return std::to_string(seconds / kMinute) + " min " + std::to_string(seconds % kMinute) + " s";
  }
  return std::to_string(seconds / kHour) + " h " + std::to_string(seconds % kHour / kMinute) +
         " min";
}

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
  if (!begin_step_) {
    begin_step_ = step;
    begin_ = now;
  }
  const std::size_t percent = step * 100 / total_steps;
  const std::size_t filled = percent * kWidth / 100;
  std::ostringstream line;
  line << "\r[" << std::string(filled, '#') << std::string(kWidth - filled, ' ') << "] "
       << std::setw(3) << percent << " %  t = " << std::fixed << std::setprecision(2) << time
       << " s";
  if (step > *begin_step_) {
    const std::chrono::duration<double> per_step =
        std::chrono::duration<double>(now - begin_) / static_cast<double>(step - *begin_step_);
    line << "  remaining: " << duration_text(per_step * static_cast<double>(total_steps - step));
  }
  line << "\x1b[K";
  std::cerr << line.str() << std::flush;
}

}  // namespace vat
