#pragma once

#include <utility>

#include "core/support/check.h"
#include "server/session/ticks/tick_clock.h"

namespace vat {

/// Playing state, requested speed and measured rate of a session. Not thread-safe.
class SessionClock {
 public:
  bool playing() const { return playing_; }
  double speed() const { return speed_; }       ///< requested simulated seconds per second
  double rate() const { return rate_.rate(); }  ///< measured simulated seconds per second
  /// Returns true if a playing session is slower than its requested speed.
  bool is_slow() const { return playing_ && rate_.slower_than(speed_); }

  /// Sets playing state and speed from a log or a recording. Does not interrupt control.step.
  void set(bool playing, double speed) {
    playing_ = playing;
    speed_ = speed;
  }
  /// Sets the playing state and interrupts control.step. A change restarts the rate measurement.
  void set_playing(bool playing) {
    interrupt();
    if (playing != playing_) restart_rate();
    playing_ = playing;
  }
  void set_speed(double speed) {
    VAT_CHECK(speed > 0);
    speed_ = speed;
    restart_rate();
  }
  void tick_done(SteadyClock::time_point now, double tick_seconds) {
    rate_.tick_done(now, tick_seconds);
  }
  void restart_rate() { rate_ = {}; }

  /// Ends the ticks of control.step after another control command, another scene, or a failed
  /// guard.
  void interrupt() { interrupted_ = true; }
  /// Returns true for the first call after interrupt().
  bool take_interruption() { return std::exchange(interrupted_, false); }

 private:
  RateMeter rate_;
  bool playing_ = true;
  double speed_ = 1;
  bool interrupted_ = false;
};

}  // namespace vat
