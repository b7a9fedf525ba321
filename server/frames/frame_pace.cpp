#include "server/frames/frame_pace.h"

#include <algorithm>

#include "core/support/check.h"
#include "protocol/frame/grid_frame.h"

namespace vat {
namespace {

using Seconds = std::chrono::duration<double>;

// An adjustment needs some time, some frames and an acknowledgement. A client without
// acknowledgements gives no information about its rate.
constexpr Seconds kInterval(0.5);
constexpr unsigned kMinDue = 4;

// Delays beyond the least one, which is the network's delay without queues.
constexpr Seconds kLongQueue(0.1);
constexpr Seconds kShortQueue(0.05);

constexpr Seconds kMinCalmTime(1);
constexpr Seconds kMaxCalmTime(32);

constexpr unsigned kPrecisionLevels = 2;

// A frame of so many particles takes one or two TCP segments.
constexpr std::size_t kFewParticles = 2000;

}  // namespace

std::uint8_t least_detail(std::size_t particles) {
  std::uint8_t detail = kFullDetail;
  for (; detail > 0 && particles / 2 >= kFewParticles; --detail) particles /= 2;
  return detail;
}

void FramePace::set_least_detail(std::uint8_t least) {
  VAT_CHECK(least <= kFullDetail);
  least_detail_ = least;
  level_ = std::min(level_, lowest());
}

void FramePace::frame_due(bool is_ready, const AckDelays& delays, SteadyClock::time_point now) {
  if (due_ == 0) interval_began_ = now;
  if (calm_since_ == SteadyClock::time_point{}) calm_since_ = now;
  ++due_;
  if (!is_ready) ++missed_;
  if (now - interval_began_ < kInterval || due_ < kMinDue || delays.count == acks_) return;
  adjust(delays, now);
  acks_ = delays.count;
  due_ = missed_ = 0;
}

void FramePace::adjust(const AckDelays& delays, SteadyClock::time_point now) {
  const Seconds queue = delays.mean - delays.least;
  if (4 * missed_ > due_ || queue > kLongQueue) {
    lower(5 * missed_ > 3 * due_ ? 2 : 1, now);
  } else if (missed_ > 0 || queue > kShortQueue) {
    calm_since_ = now;
  } else if (now - calm_since_ >= calm_time_) {
    raise(now);
  }
}

void FramePace::lower(unsigned levels, SteadyClock::time_point now) {
  if (was_raised_ && now - raised_at_ < 2 * calm_time_)
    calm_time_ = std::min(2 * calm_time_, kMaxCalmTime);
  was_raised_ = false;
  level_ = std::min(level_ + levels, lowest());
  calm_since_ = now;
  VAT_CHECK(level_ <= lowest());
}

void FramePace::raise(SteadyClock::time_point now) {
  if (was_raised_)
    calm_time_ = std::max(calm_time_ / 2, kMinCalmTime);  // the last raise was stable
  calm_since_ = now;
  if (level_ == 0) return;
  --level_;
  was_raised_ = true;
  raised_at_ = now;
}

unsigned FramePace::lowest() const {
  return max_stride_ - 1 + kPrecisionLevels + kFullDetail - least_detail_;
}

unsigned FramePace::beyond_stride() const {
  return level_ - std::min(level_, max_stride_ - 1);
}

unsigned FramePace::stride() const {
  return std::min(level_ + 1, max_stride_);
}

unsigned FramePace::coarseness() const {
  return 1U << std::min(beyond_stride(), kPrecisionLevels);
}

std::uint8_t FramePace::detail() const {
  const unsigned less = beyond_stride() - std::min(beyond_stride(), kPrecisionLevels);
  VAT_CHECK(less <= kFullDetail);
  return static_cast<std::uint8_t>(kFullDetail - less);
}

}  // namespace vat
