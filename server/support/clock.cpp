#include "server/support/clock.h"

#include <boost/asio/steady_timer.hpp>
#include <utility>

namespace vat {
namespace {

class SystemTimer final : public Timer {
 public:
  explicit SystemTimer(boost::asio::any_io_executor executor) : timer_(std::move(executor)) {}

  void start(SteadyClock::time_point time, std::function<void()> task) override {
    timer_.expires_at(time);
    timer_.async_wait([task = std::move(task)](const boost::system::error_code& cancelled) {
      if (!cancelled) task();
    });
  }
  void cancel() override { timer_.cancel(); }

 private:
  boost::asio::steady_timer timer_;
};

}  // namespace

double SystemClock::wall_time() const {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

std::unique_ptr<Timer> SystemClock::make_timer(boost::asio::any_io_executor executor) {
  return std::make_unique<SystemTimer>(std::move(executor));
}

}  // namespace vat
