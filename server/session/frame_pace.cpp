#include "server/session/frame_pace.h"

#include <algorithm>

#include "protocol/frame/grid_frame.h"

namespace vat {
namespace {

using Seconds = std::chrono::duration<double>;

// A judgement needs some time, some frames and an acknowledgement: one who answers nothing at all
// tells nothing about the pace.
constexpr Seconds kLook(0.5);
constexpr unsigned kMinDue = 4;

// Of acknowledgements beyond the least delay, which is that of the way and not of its queues.
constexpr Seconds kLongQueue(0.1);
constexpr Seconds kShortQueue(0.05);

constexpr Seconds kShortestWhile(1);
constexpr Seconds kLongestWhile(32);

constexpr unsigned kPrecisionLevels = 2;

// A frame of so many takes one segment of TCP or two.
constexpr std::size_t kFewParticles = 2000;

}  // namespace

std::uint8_t least_detail(std::size_t particles) {
  std::uint8_t detail = kFullDetail;
  for (; detail > 0 && particles / 2 >= kFewParticles; --detail) particles /= 2;
  return detail;
}

void FramePace::set_least_detail(std::uint8_t least) {
  least_detail_ = least;
  level_ = std::min(level_, lowest());
}

void FramePace::frame_due(bool is_ready, const AckDelays& delays, SteadyClock::time_point now) {
  if (due_ == 0) look_began_ = now;
  if (fine_since_ == SteadyClock::time_point{}) fine_since_ = now;
  ++due_;
  if (!is_ready) ++missed_;
  if (now - look_began_ < kLook || due_ < kMinDue || delays.count == acks_) return;
  judge(delays, now);
  acks_ = delays.count;
  due_ = missed_ = 0;
}

void FramePace::judge(const AckDelays& delays, SteadyClock::time_point now) {
  const Seconds queue = delays.mean - delays.least;
  if (4 * missed_ > due_ || queue > kLongQueue) {
    lower(5 * missed_ > 3 * due_ ? 2 : 1, now);
  } else if (missed_ > 0 || queue > kShortQueue) {
    fine_since_ = now;
  } else if (now - fine_since_ >= while_) {
    raise(now);
  }
}

void FramePace::lower(unsigned levels, SteadyClock::time_point now) {
  if (has_risen_ && now - raised_at_ < 2 * while_) while_ = std::min(2 * while_, kLongestWhile);
  has_risen_ = false;
  level_ = std::min(level_ + levels, lowest());
  fine_since_ = now;
}

void FramePace::raise(SteadyClock::time_point now) {
  if (has_risen_) while_ = std::max(while_ / 2, kShortestWhile);  // the last rise has held
  fine_since_ = now;
  if (level_ == 0) return;
  --level_;
  has_risen_ = true;
  raised_at_ = now;
}

unsigned FramePace::lowest() const {
  return most_stride_ - 1 + kPrecisionLevels + kFullDetail - least_detail_;
}

unsigned FramePace::beyond_stride() const {
  return level_ - std::min(level_, most_stride_ - 1);
}

unsigned FramePace::stride() const {
  return std::min(level_ + 1, most_stride_);
}

unsigned FramePace::coarseness() const {
  return 1U << std::min(beyond_stride(), kPrecisionLevels);
}

std::uint8_t FramePace::detail() const {
  const unsigned less = beyond_stride() - std::min(beyond_stride(), kPrecisionLevels);
  return static_cast<std::uint8_t>(kFullDetail - less);
}

}  // namespace vat
