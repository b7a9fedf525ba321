#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "server/session/tick_clock.h"

namespace vat {

/// How long a client's acknowledgements take, from sending a frame.
struct AckDelays {
  std::uint64_t count = 0;                ///< of acknowledgements
  std::chrono::duration<double> mean{};   ///< of the last few, the later the more
  std::chrono::duration<double> least{};  ///< of the last ten to twenty seconds
};

/// The frames that were sent to a client and are not acknowledged.
class FrameWindow {
 public:
  /// Forgets them: another session counts its own numbers.
  void clear();
  void sent(std::uint32_t number, SteadyClock::time_point now);
  /// All frames up to this number. False if none so late was sent.
  bool acknowledge(std::uint32_t number, SteadyClock::time_point now);

  std::size_t in_flight() const { return in_flight_.size(); }
  const AckDelays& delays() const { return delays_; }
  /// Since when the client owes an acknowledgement: since it was sent the oldest frame in flight.
  std::optional<SteadyClock::time_point> waits_since() const;

 private:
  struct Sent {
    std::uint32_t number;
    SteadyClock::time_point at;
  };
  void measure(std::chrono::duration<double> delay, SteadyClock::time_point now);

  std::deque<Sent> in_flight_;  // the oldest first
  std::uint32_t last_sent_ = 0;
  AckDelays delays_;
  // The least delays of two spans of time, the one that runs and the one before.
  SteadyClock::time_point span_began_{};
  std::chrono::duration<double> least_now_{};
  std::chrono::duration<double> least_before_{};
};

}  // namespace vat
