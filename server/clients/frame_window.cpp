#include "server/clients/frame_window.h"

#include <algorithm>
#include "core/support/check.h"

namespace vat {
namespace {

constexpr auto kSpan = std::chrono::seconds(10);
constexpr double kWeight = 0.25;  // of the latest delay in the mean

}  // namespace

void FrameWindow::clear() {
  in_flight_.clear();
  last_sent_ = 0;
}

void FrameWindow::sent(std::uint32_t number, SteadyClock::time_point now) {
  VAT_CHECK(number >= last_sent_);
  in_flight_.push_back({number, now});
  last_sent_ = number;
}

bool FrameWindow::acknowledge(std::uint32_t number, SteadyClock::time_point now) {
  if (number == 0 || number > last_sent_) return false;
  std::optional<SteadyClock::time_point> sent_at;
  while (!in_flight_.empty() && in_flight_.front().number <= number) {
    sent_at = in_flight_.front().at;
    in_flight_.pop_front();
  }
  // Acknowledgement and frame are on different threads. A client can acknowledge a frame that was
  // sent after `now`, because it knows the number from an earlier subscription or guesses it.
  if (sent_at && *sent_at <= now) measure(now - *sent_at, now);
  return true;
}

std::optional<SteadyClock::time_point> FrameWindow::waits_since() const {
  if (in_flight_.empty()) return {};
  return in_flight_.front().at;
}

void FrameWindow::measure(std::chrono::duration<double> delay, SteadyClock::time_point now) {
  VAT_CHECK(delay.count() >= 0);
  if (delays_.count == 0) {
    delays_.mean = least_now_ = least_before_ = delay;
    span_began_ = now;
  }
  ++delays_.count;
  delays_.mean += kWeight * (delay - delays_.mean);
  if (now - span_began_ >= kSpan) {
    least_before_ = least_now_;
    least_now_ = delay;
    span_began_ = now;
  }
  least_now_ = std::min(least_now_, delay);
  delays_.least = std::min(least_now_, least_before_);
}

}  // namespace vat
