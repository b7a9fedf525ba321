#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "server/support/stage_clock.h"

namespace vat {

/// A tick of a playing session that took longer than its period.
struct SlowTick {
  using Time = std::chrono::steady_clock::time_point;

  std::string session;
  std::uint64_t tick = 0;
  std::chrono::steady_clock::duration period{};
  Time due;  ///< not later than begin
  Time begin;
  Time stepped;                          ///< end of the simulation steps
  Time published;                        ///< end of the tick
  std::vector<StageClock::Span> stages;  ///< empty if the stages were not measured
};

/// The last slow ticks of a server. Thread-safe.
class SlowTicks {
 public:
  static constexpr std::size_t kMaxTicks = 32;

  void add(SlowTick tick);
  /// Returns the ticks in the trace event format of Chrome (JSON), which chrome://tracing and
  /// https://ui.perfetto.dev display. Each session is a thread.
  std::string trace() const;

 private:
  mutable std::mutex mutex_;
  std::deque<SlowTick> ticks_;
};

}  // namespace vat
