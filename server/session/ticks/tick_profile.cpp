#include "server/session/ticks/tick_profile.h"

#include <algorithm>
#include "core/support/check.h"

namespace vat {
namespace {

// Cost per stage: one reading of the clock and the search for the name, rounded up.
constexpr std::chrono::nanoseconds kMeasureTime(40);
constexpr std::uint64_t kOneIn = 200;  // share of the time for measuring
constexpr std::uint64_t kLongestPeriod = 100;

}  // namespace

StageObserver* TickProfile::next_observer() {
  is_measured_ = ++ticks_since_measured_ >= period_;
  clock_.clear();
  return is_measured_ ? &clock_ : nullptr;
}

void TickProfile::tick_done(Clock::duration time, const AdvanceReport& report,
                            ServerMetrics& metrics) {
  ++totals_.ticks;
  totals_.substeps += report.steps;
  totals_.undone_substeps += report.undone_steps;
  totals_.device_steps += report.device_steps;
  totals_.time += time;
  totals_.longest_tick = std::max(totals_.longest_tick, time);
  if (is_measured_) count_stages(time);
  metrics.add_tick({time, report.steps, report.undone_steps,
                    is_measured_ ? tick_stages_ : std::span<const StageClock::Stage>()});
}

std::span<const StageClock::Span> TickProfile::spans() const {
  return clock_.spans();
}

void TickProfile::count_stages(Clock::duration tick_time) {
  const std::vector<StageClock::Stage>& stages_seen = clock_.stages();
  VAT_CHECK(tick_stages_.size() <= stages_seen.size());
  for (std::size_t s = tick_stages_.size(); s < stages_seen.size(); ++s) {
    tick_stages_.push_back({.name = stages_seen[s].name});
    totals_.stages.push_back({.name = stages_seen[s].name});
  }
  std::uint64_t measurements = 0;
  VAT_CHECK(totals_.stages.size() == stages_seen.size());
  for (std::size_t s = 0; s < stages_seen.size(); ++s) {
    measurements += stages_seen[s].calls;
    tick_stages_[s].calls = ticks_since_measured_ * stages_seen[s].calls;
    tick_stages_[s].time = static_cast<Clock::rep>(ticks_since_measured_) * stages_seen[s].time;
    totals_.stages[s].calls += tick_stages_[s].calls;
    totals_.stages[s].time += tick_stages_[s].time;
  }
  ticks_since_measured_ = 0;
  const Clock::duration cost = static_cast<Clock::rep>(measurements * kOneIn) * kMeasureTime;
  const auto wanted = static_cast<std::uint64_t>(cost / std::max(tick_time, Clock::duration(1)));
  period_ = std::clamp<std::uint64_t>(wanted + 1, 1, kLongestPeriod);
}

}  // namespace vat
