#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <chrono>
#include <functional>
#include <memory>

namespace vat {

/// Time at which the server schedules. `Clock` reads it.
using SteadyClock = std::chrono::steady_clock;
/// Measures the cost of work. Tests do not control it. Scheduling uses `Clock`.
using CostClock = std::chrono::steady_clock;

/// Runs one task at a given time on one executor. Used by one thread at a time.
class Timer {
 public:
  Timer() = default;
  virtual ~Timer() = default;
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

  /// Replaces the waiting task, if any.
  virtual void start(SteadyClock::time_point time, std::function<void()> task) = 0;
  /// Drops the waiting task. A task that is due may already be queued and then still runs.
  virtual void cancel() = 0;
};

/// Source of time and timers of a server. Tests control the time (`ManualClock`). Safe to use from
/// any thread. A clock must outlive its timers.
class Clock {
 public:
  Clock() = default;
  virtual ~Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;

  virtual SteadyClock::time_point now() const = 0;
  /// Seconds since 1970.
  virtual double wall_time() const = 0;
  virtual std::unique_ptr<Timer> make_timer(boost::asio::any_io_executor executor) = 0;
};

/// The clock of the system.
class SystemClock final : public Clock {
 public:
  SteadyClock::time_point now() const override { return SteadyClock::now(); }
  double wall_time() const override;
  std::unique_ptr<Timer> make_timer(boost::asio::any_io_executor executor) override;
};

}  // namespace vat
