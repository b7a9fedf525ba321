#pragma once

#include <cstddef>
#include <cstdint>

#include "server/session/frame_window.h"

namespace vat {

/// The least level of detail (0 to kFullDetail) that leaves 2000 particles, or all of them: a
/// viewer that is slow with so few would not gain by fewer.
std::uint8_t least_detail(std::size_t particles);

/// How much less than it asked for a viewer gets, so that its frames stay young: found from the
/// frames that it misses and from how long its acknowledgements take. The rate goes down first, to
/// a quarter, then the precision, to a quarter, then the detail; and up again in the opposite
/// order, after a while in which all went well. A rise that fails makes the next while longer.
class FramePace {
 public:
  /// `most_stride` (1 to 4) bounds how far the rate goes down.
  explicit FramePace(unsigned most_stride = 4) : most_stride_(most_stride) {}

  /// The detail goes down no further than to this (0 to kFullDetail; at first 0).
  void set_least_detail(std::uint8_t least);

  /// A frame is due: whether the viewer is ready for it, and its acknowledgements so far.
  void frame_due(bool is_ready, const AckDelays& delays, SteadyClock::time_point now);

  unsigned stride() const;      ///< one frame of so many
  unsigned coarseness() const;  ///< 1, 2, 4: times the error that it asked for
  std::uint8_t detail() const;  ///< at most

 private:
  using Seconds = std::chrono::duration<double>;
  void judge(const AckDelays& delays, SteadyClock::time_point now);
  void lower(unsigned levels, SteadyClock::time_point now);
  void raise(SteadyClock::time_point now);
  unsigned beyond_stride() const;
  unsigned lowest() const;

  unsigned most_stride_;
  std::uint8_t least_detail_ = 0;
  unsigned level_ = 0;  // 0: all that it asked for
  // Since the last judgement.
  SteadyClock::time_point look_began_{};
  std::uint64_t acks_ = 0;
  unsigned due_ = 0;
  unsigned missed_ = 0;

  SteadyClock::time_point fine_since_{};
  SteadyClock::time_point raised_at_{};
  bool has_risen_ = false;  // by the last change
  Seconds while_{1};        // that must be fine before a rise
};

}  // namespace vat
