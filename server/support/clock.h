#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <chrono>
#include <functional>
#include <memory>

namespace vat {

/// Type of the times that `Clock` returns and that the server uses for scheduling.
using SteadyClock = std::chrono::steady_clock;
/// Clock for measurements of computing cost. Tests cannot control this clock.
using CostClock = std::chrono::steady_clock;

/// Timer that runs one task at a given time on an executor. Not thread-safe.
class Timer {
 public:
  Timer() = default;
  virtual ~Timer() = default;
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

  /// Sets the task and its time. Replaces the waiting task, if any.
  virtual void start(SteadyClock::time_point time, std::function<void()> task) = 0;
  /// Drops the waiting task. A due task may already be queued, and is then executed.
  virtual void cancel() = 0;
};

/// Source of time and timers of a server. Tests control the time with `ManualClock`. Thread-safe. A
/// clock must outlive its timers.
class Clock {
 public:
  Clock() = default;
  virtual ~Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;

  virtual SteadyClock::time_point now() const = 0;
  /// Returns the time [s since 1970].
  virtual double wall_time() const = 0;
  virtual std::unique_ptr<Timer> make_timer(boost::asio::any_io_executor executor) = 0;
};

/// Clock of the system.
class SystemClock final : public Clock {
 public:
  SteadyClock::time_point now() const override { return SteadyClock::now(); }
  double wall_time() const override;
  std::unique_ptr<Timer> make_timer(boost::asio::any_io_executor executor) override;
};

}  // namespace vat
