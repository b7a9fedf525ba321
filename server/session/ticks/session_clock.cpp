#include "server/session/ticks/session_clock.h"

#include <utility>

#include "core/support/check.h"

namespace vat {

void SessionClock::set(bool playing, double speed) {
  playing_ = playing;
  speed_ = speed;
}

void SessionClock::set_playing(bool playing) {
  interrupt();
  if (playing != playing_) restart_rate();
  playing_ = playing;
}

void SessionClock::set_speed(double speed) {
  VAT_CHECK(speed > 0);
  speed_ = speed;
  restart_rate();
}

bool SessionClock::take_interruption() {
  return std::exchange(interrupted_, false);
}

}  // namespace vat
