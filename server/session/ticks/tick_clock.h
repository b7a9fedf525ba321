#pragma once

#include <deque>

#include "server/support/clock.h"

namespace vat {

/// Due times of the ticks of a playing session. A late tick is made up for by at most one period;
/// beyond that the schedule is delayed, and the session runs in slow motion.
class TickClock {
 public:
  /// The first tick is due one period from now. The period must be above 0.
  void start(SteadyClock::time_point now, SteadyClock::duration period);
  SteadyClock::time_point due() const { return due_; }
  /// Sets the next tick's time; `now` is the end of the tick that was due.
  void tick_done(SteadyClock::time_point now);

 private:
  SteadyClock::time_point due_{};
  SteadyClock::duration period_{};
};

/// Returns the wall time of one tick of `tick_seconds` at `speed` simulated seconds per second.
SteadyClock::duration tick_period(double tick_seconds, double speed);

/// Measures simulated seconds per second, over about the last second.
class RateMeter {
 public:
  void tick_done(SteadyClock::time_point now, double tick_seconds);
  /// Returns 0 before the second tick.
  double rate() const;
  /// Whether the rate was below `speed` by more than a tenth over the whole window.
  bool slower_than(double speed) const;

 private:
  struct Sample {
    SteadyClock::time_point at;
    double seconds;  // simulated, since the first sample
  };
  std::deque<Sample> samples_;
};

}  // namespace vat
