#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <string_view>
#include <vector>

#include "core/stage/observer.h"

namespace vat {

/// Measurement of the wall time of a simulation's stages. A stage is a part of a step. Reads the
/// clock only once per stage, so that the measurement can always be enabled.
class StageClock final : public StageObserver {
 public:
  using Clock = std::chrono::steady_clock;
  struct Stage {
    std::string_view name;
    std::uint64_t calls = 0;
    Clock::duration time{};

    double seconds() const { return std::chrono::duration<double>(time).count(); }
  };

  /// One execution of a stage.
  struct Span {
    std::string_view name;
    Clock::time_point begin;
    Clock::time_point end;
  };
  static constexpr std::size_t kMaxSpans = 1024;

  /// `now` returns the current time.
  explicit StageClock(Clock::time_point (*now)() = Clock::now) : now_(now) {}

  void stage_begins(std::string_view stage) override;
  void stages_end() override;

  /// Returns the stages in the order of their first execution.
  const std::vector<Stage>& stages() const { return stages_; }
  /// Returns the first kMaxSpans executions in their order.
  const std::vector<Span>& spans() const { return spans_; }
  /// Removes all spans and sets all times to zero. The names and indices of stages do not change.
  void clear();

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};
  void charge_running();
  std::size_t find(std::string_view name);

  Clock::time_point (*now_)();
  std::vector<Stage> stages_;  // about twenty elements
  std::vector<Span> spans_;
  std::size_t running_ = kNone;  // index into stages_
  Clock::time_point since_;      // start of the running stage
};

/// Returns the processor time of the calling thread.
inline std::chrono::duration<double> thread_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace vat
