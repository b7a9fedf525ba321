#pragma once

#include <memory>

#include "server/support/clock.h"

namespace vat::bench {

/// Clock that runs `factor` times slower than that of the system. For a program that takes its time
/// from this clock, the machine is `factor` times faster.
class SlowClock final : public Clock {
 public:
  /// `factor` is at least 1.
  explicit SlowClock(double factor);

  SteadyClock::time_point now() const override;
  double wall_time() const override { return system_.wall_time(); }
  std::unique_ptr<Timer> make_timer(boost::asio::any_io_executor executor) override;

  /// Returns the time of the system at a time of this clock.
  SteadyClock::time_point system_time(SteadyClock::time_point time) const;

 private:
  SystemClock system_;
  const double factor_;
  const SteadyClock::time_point begin_;
};

}  // namespace vat::bench
