#include "tests/bench/cluster/slow_clock.h"

#include <utility>

#include "core/support/check.h"

namespace vat::bench {
namespace {

class SlowTimer final : public Timer {
 public:
  SlowTimer(const SlowClock& clock, std::unique_ptr<Timer> timer)
      : clock_(clock), timer_(std::move(timer)) {}

  void start(SteadyClock::time_point time, std::function<void()> task) override {
    timer_->start(clock_.system_time(time), std::move(task));
  }
  void cancel() override { timer_->cancel(); }

 private:
  const SlowClock& clock_;
  const std::unique_ptr<Timer> timer_;
};

SteadyClock::duration multiplied(SteadyClock::duration time, double factor) {
  using Exact = std::chrono::duration<double, SteadyClock::period>;
  return std::chrono::duration_cast<SteadyClock::duration>(Exact(time) * factor);
}

}  // namespace

SlowClock::SlowClock(double factor) : factor_(factor), begin_(system_.now()) {
  VAT_CHECK(factor >= 1);
}

SteadyClock::time_point SlowClock::now() const {
  return begin_ + multiplied(system_.now() - begin_, 1 / factor_);
}

std::unique_ptr<Timer> SlowClock::make_timer(boost::asio::any_io_executor executor) {
  return std::make_unique<SlowTimer>(*this, system_.make_timer(std::move(executor)));
}

SteadyClock::time_point SlowClock::system_time(SteadyClock::time_point time) const {
  return begin_ + multiplied(time - begin_, factor_);
}

}  // namespace vat::bench
