#include "server/session/ticks/governor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/support/check.h"

namespace vat {

std::optional<std::size_t> Governor::add(const GovernorSample& sample, std::size_t point,
                                         std::span<const GovernorPoint> points) {
  VAT_CHECK(point < points.size() && points.size() <= kMaxGovernorPoints);
  note_point(point);
  wait(sample.seconds);
  behind_ = sample.is_behind ? behind_ + sample.seconds : 0;
  const bool can_return =
      point > 0 && !sample.is_behind &&
      sample.load * points[point - 1].seconds / points[point].seconds <= kMostLoad;
  reserve_ = can_return ? reserve_ + sample.seconds : 0;
  if (behind_ >= kBehindSeconds) return find_cheaper(point, points.size());
  if (reserve_ >= kReserveSeconds && waits_[point - 1] <= 0) {
    restart();
    return_ = point - 1;
    return return_;
  }
  return {};
}

std::optional<std::size_t> Governor::find_cheaper(std::size_t point, std::size_t count) {
  for (std::size_t next = point + 1; next < count; ++next) {
    if (waits_[next] > 0) continue;
    if (trial_ > 0) fail(point);
    restart();
    return next;
  }
  return {};
}

void Governor::fail(std::size_t point) {
  VAT_CHECK(point < kMaxGovernorPoints);
  constexpr std::uint32_t kMostDoublings = 10;
  const std::uint32_t doublings = std::min(failures_[point]++, kMostDoublings);
  waits_[point] = std::min(std::ldexp(kLeastWait, static_cast<int>(doublings)), kMostWait);
}

void Governor::restart() {
  behind_ = reserve_ = 0;
}

void Governor::note_point(std::size_t point) {
  const std::optional<std::size_t> returned = std::exchange(return_, std::nullopt);
  if (point_ == point) return;
  point_ = point;
  trial_ = returned == point ? kTrialSeconds : 0;
  restart();
}

void Governor::wait(double seconds) {
  for (double& left : waits_) left = std::max(0.0, left - seconds);
  if (trial_ <= 0) return;
  trial_ -= seconds;
  if (trial_ <= 0) failures_[*point_] = 0;
}

}  // namespace vat
