#pragma once

#include <cstddef>
#include <cstdint>

#include "server/clients/frame_window.h"

namespace vat {

/// Returns the lowest level of detail (0 to kFullDetail) with at least 2000 particles. Returns
/// kFullDetail if there are too few particles. Fewer particles would not make a slow viewer faster.
std::uint8_t least_detail(std::size_t particles);

/// Adaptation of frames to a slow viewer, so that the displayed frames are recent. Uses the number
/// of missed frames and the delays of acknowledgements. Reduces first the rate to a quarter, then
/// the precision to a quarter, then the detail. Increases the values in reverse order after a
/// period without delays. An unsuccessful increase lengthens the next period.
class FramePace {
 public:
  /// `max_stride` (1 to 4) is the greatest divisor of the rate.
  explicit FramePace(unsigned max_stride = 4) : max_stride_(max_stride) {}

  /// Sets the lowest level of detail (0 to kFullDetail). The initial value is 0.
  void set_least_detail(std::uint8_t least);

  /// Records that a frame is due, whether the viewer is ready, and the viewer's acknowledgements so
  /// far.
  void frame_due(bool is_ready, const AckDelays& delays, SteadyClock::time_point now);

  unsigned stride() const;      ///< every stride-th due frame is sent
  unsigned coarseness() const;  ///< factor of the requested error: 1, 2 or 4
  std::uint8_t detail() const;  ///< greatest level of detail

 private:
  using Seconds = std::chrono::duration<double>;
  void adjust(const AckDelays& delays, SteadyClock::time_point now);
  void lower(unsigned levels, SteadyClock::time_point now);
  void raise(SteadyClock::time_point now);
  unsigned beyond_stride() const;
  unsigned lowest() const;

  unsigned max_stride_;
  std::uint8_t least_detail_ = 0;
  unsigned level_ = 0;  // number of reductions
  // Values since the last change of the level.
  SteadyClock::time_point interval_began_{};
  std::uint64_t acks_ = 0;
  unsigned due_ = 0;
  unsigned missed_ = 0;

  SteadyClock::time_point calm_since_{};
  SteadyClock::time_point raised_at_{};
  bool was_raised_ = false;  // the last change was an increase
  Seconds calm_time_{1};     // required time without delays before an increase
};

}  // namespace vat
