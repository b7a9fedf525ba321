#include "server/session/tick_profile.h"

#include <algorithm>

namespace vat {
namespace {

// Of a stage: one reading of the clock and finding the name, rounded up.
constexpr std::chrono::nanoseconds kLookTime(40);
constexpr std::uint64_t kOneIn = 200;  // of the time may go into looking
constexpr std::uint64_t kLongestPeriod = 100;

}  // namespace

StageObserver* TickProfile::next_observer() {
  is_looking_ = ++since_look_ >= period_;
  return is_looking_ ? &clock_ : nullptr;
}

void TickProfile::tick_done(Clock::duration time, const AdvanceReport& report,
                            ServerMetrics& metrics) {
  ++totals_.ticks;
  totals_.substeps += report.steps;
  totals_.undone_substeps += report.undone_steps;
  totals_.time += time;
  totals_.longest_tick = std::max(totals_.longest_tick, time);
  if (is_looking_) count_stages(time);
  metrics.add_tick({time, report.steps, report.undone_steps,
                    is_looking_ ? tick_stages_ : std::span<const StageClock::Stage>()});
}

void TickProfile::count_stages(Clock::duration tick_time) {
  const std::vector<StageClock::Stage>& seen = clock_.stages();
  for (std::size_t s = tick_stages_.size(); s < seen.size(); ++s) {
    tick_stages_.push_back({.name = seen[s].name});
    totals_.stages.push_back({.name = seen[s].name});
  }
  std::uint64_t looks = 0;
  for (std::size_t s = 0; s < seen.size(); ++s) {
    looks += seen[s].calls;
    tick_stages_[s].calls = since_look_ * seen[s].calls;
    tick_stages_[s].time = static_cast<Clock::rep>(since_look_) * seen[s].time;
    totals_.stages[s].calls += tick_stages_[s].calls;
    totals_.stages[s].time += tick_stages_[s].time;
  }
  clock_.clear();
  since_look_ = 0;
  const Clock::duration cost = static_cast<Clock::rep>(looks * kOneIn) * kLookTime;
  const auto wanted = static_cast<std::uint64_t>(cost / std::max(tick_time, Clock::duration(1)));
  period_ = std::clamp<std::uint64_t>(wanted + 1, 1, kLongestPeriod);
}

}  // namespace vat
