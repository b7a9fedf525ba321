#include "server/session/ticks/tick_clock.h"

#include <algorithm>

#include "core/support/check.h"

namespace vat {
namespace {

constexpr auto kRateWindow = std::chrono::seconds(1);
// Shorter measurements depend too much on single ticks.
constexpr auto kShortestMeasure = std::chrono::milliseconds(500);
constexpr double kSlowShare = 0.9;  // of the set speed

}  // namespace

void TickClock::start(SteadyClock::time_point now, SteadyClock::duration period) {
  VAT_CHECK(period > SteadyClock::duration::zero());
  period_ = period;
  due_ = now + period;
}

void TickClock::tick_done(SteadyClock::time_point now) {
  VAT_CHECK(period_ > SteadyClock::duration::zero());
  due_ = std::max(due_ + period_, now - period_);
}

SteadyClock::duration tick_period(double tick_seconds, double speed) {
  VAT_CHECK(tick_seconds > 0 && speed > 0);
  const auto period = std::chrono::duration_cast<SteadyClock::duration>(
      std::chrono::duration<double>(tick_seconds / speed));
  return std::max(period, SteadyClock::duration(1));
}

void RateMeter::tick_done(SteadyClock::time_point now, double tick_seconds) {
  VAT_CHECK(samples_.empty() || now >= samples_.back().at);
  const double before = samples_.empty() ? -tick_seconds : samples_.back().seconds;
  samples_.push_back({now, before + tick_seconds});
  // The first sample left is the last one outside the window, so that slow ticks are measured too.
  while (samples_.size() > 2 && now - samples_[1].at >= kRateWindow) samples_.pop_front();
}

double RateMeter::rate() const {
  if (samples_.size() < 2) return 0;
  const std::chrono::duration<double> wall = samples_.back().at - samples_.front().at;
  if (wall.count() <= 0) return 0;
  return (samples_.back().seconds - samples_.front().seconds) / wall.count();
}

bool RateMeter::slower_than(double speed) const {
  if (samples_.size() < 2) return false;
  if (samples_.back().at - samples_.front().at < kShortestMeasure) return false;
  return rate() < kSlowShare * speed;
}

}  // namespace vat
