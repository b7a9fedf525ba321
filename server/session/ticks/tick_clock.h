#pragma once

#include <deque>

#include "server/support/clock.h"

namespace vat {

/// Schedule of the ticks of a playing session. The schedule recovers a delay of at most one period.
/// A longer delay shifts the schedule, and the session runs in slow motion.
class TickClock {
 public:
  /// Starts the schedule. The first tick is due after one period. The period must be above 0.
  void start(SteadyClock::time_point now, SteadyClock::duration period);
  SteadyClock::time_point due() const { return due_; }
  /// Sets the time of the next tick. `now` is the end of the previous tick.
  void tick_done(SteadyClock::time_point now);

 private:
  SteadyClock::time_point due_{};
  SteadyClock::duration period_{};
};

/// Returns the wall time of one tick. `tick_seconds` is simulated time [s], and `speed` is in
/// simulated seconds per second.
SteadyClock::duration tick_period(double tick_seconds, double speed);

/// Meter of simulated seconds per second, over about the last second.
class RateMeter {
 public:
  void tick_done(SteadyClock::time_point now, double tick_seconds);
  /// Returns the rate, or 0 before the second tick.
  double rate() const;
  /// Returns whether the rate in the window is below 0.9 * `speed`.
  bool slower_than(double speed) const;

 private:
  struct Sample {
    SteadyClock::time_point at;
    double seconds;  // simulated time since the first sample
  };
  std::deque<Sample> samples_;
};

}  // namespace vat
