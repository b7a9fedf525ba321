#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "server/support/clock.h"

namespace vat {

/// Delays between the transmission of a frame and its acknowledgement.
struct AckDelays {
  std::uint64_t count = 0;                ///< number of acknowledgements
  std::chrono::duration<double> mean{};   ///< weighted mean; recent delays have more weight
  std::chrono::duration<double> least{};  ///< least delay of the last 10 to 20 seconds
};

/// Frames that were sent to a client and are not acknowledged.
class FrameWindow {
 public:
  /// Removes all frames. Another session has other frame numbers.
  void clear();
  void sent(std::uint32_t number, SteadyClock::time_point now);
  /// Acknowledges all frames up to this number. Returns false if no frame with this number was
  /// sent.
  bool acknowledge(std::uint32_t number, SteadyClock::time_point now);

  std::size_t in_flight() const { return in_flight_.size(); }
  const AckDelays& delays() const { return delays_; }
  /// Returns the time at which the oldest unacknowledged frame was sent.
  std::optional<SteadyClock::time_point> waits_since() const;

 private:
  struct Sent {
    std::uint32_t number;
    SteadyClock::time_point at;
  };
  void measure(std::chrono::duration<double> delay, SteadyClock::time_point now);

  std::deque<Sent> in_flight_;  // oldest frame first
  std::uint32_t last_sent_ = 0;
  AckDelays delays_;
  // Least delays of the current and the previous time span.
  SteadyClock::time_point span_began_{};
  std::chrono::duration<double> least_now_{};
  std::chrono::duration<double> least_before_{};
};

}  // namespace vat
