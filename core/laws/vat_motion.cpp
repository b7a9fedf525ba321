#include "core/laws/vat_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/limits.h"

namespace vat {
namespace {

/// Motion along one axis: acceleration to `peak`, constant speed, and deceleration to rest.
struct AxisMotion {
  Real offset = 0;
  Real velocity = 0;
  Real acceleration = 0;
};

/// The time-optimal motion to rest at the distance `way`, from the speed `start`. It is mirrored so
/// that the first acceleration is positive.
class Approach {
 public:
  Approach(Real way, Real start) {
    const Real a = kMaxHandAcceleration;
    // The distance in which it would stop if it decelerated from now on.
    const Real stopping = start * std::abs(start) / (2 * a);
    direction_ = way < stopping ? -1 : 1;
    start_ = direction_ * start;
    way_ = direction_ * way;
    peak_ = std::min(std::sqrt(std::max(a * way_ + start_ * start_ / 2, Real{0})), kMaxHandSpeed);
    faster_ = std::max((peak_ - start_) / a, Real{0});
    const Real speeding = (start_ + peak_) / 2 * faster_;
    slower_ = peak_ / a;
    even_ = peak_ > 0 ? std::max((way_ - speeding - peak_ / 2 * slower_) / peak_, Real{0}) : 0;
  }

  Real time() const { return faster_ + even_ + slower_; }

  AxisMotion at(Real t) const {
    const Real a = kMaxHandAcceleration;
    AxisMotion motion;
    if (t < faster_) {
      motion = {(start_ + a * t / 2) * t, start_ + a * t, a};
    } else if (const Real left = time() - t; left > slower_) {
      motion = {way_ - peak_ / 2 * slower_ - peak_ * (left - slower_), peak_, 0};
    } else if (left > 0) {
      motion = {way_ - a * left * left / 2, a * left, -a};
    } else {
      motion = {way_, 0, 0};
    }
    return {direction_ * motion.offset, direction_ * motion.velocity,
            direction_ * motion.acceleration};
  }

 private:
  Real direction_ = 1;
  Real start_ = 0;
  Real way_ = 0;
  Real peak_ = 0;
  Real faster_ = 0;  // [s]
  Real even_ = 0;    // [s]
  Real slower_ = 0;  // [s]
};

Approach approach_of(const HandMotion& hand, int axis) {
  return {hand.target[axis] - hand.offset[axis], hand.velocity[axis]};
}

}  // namespace

VatMotion slide_motion(const SlideMotion& slide, Real time) {
  const Vec3 axis = slide.axis.normalized();
  const Real rate = 2 * std::numbers::pi / slide.period;
  const Real half_stroke = slide.stroke / 2;
  return {axis * (half_stroke * (1 - std::cos(rate * time))),
          axis * (half_stroke * rate * std::sin(rate * time)),
          axis * (half_stroke * rate * rate * std::cos(rate * time))};
}

VatMotion hand_motion(const HandMotion& hand, Real time) {
  VatMotion motion;
  for (int axis = 0; axis < 3; ++axis) {
    const AxisMotion along = approach_of(hand, axis).at(std::max(time - hand.start, Real{0}));
    motion.offset[axis] = hand.offset[axis] + along.offset;
    motion.velocity[axis] = along.velocity;
    motion.acceleration[axis] = along.acceleration;
  }
  return motion;
}

bool is_moving(const HandMotion& hand, Real time) {
  Real longest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    longest = std::max(longest, approach_of(hand, axis).time());
  }
  return time < hand.start + longest;
}

VatMotion vat_motion(const Vat& vat, Real time) {
  VatMotion motion;
  if (vat.motion) motion = slide_motion(*vat.motion, time);
  if (!vat.hand) return motion;
  const VatMotion by_hand = hand_motion(*vat.hand, time);
  motion.offset += by_hand.offset;
  motion.velocity += by_hand.velocity;
  motion.acceleration += by_hand.acceleration;
  return motion;
}

bool moves_walls(const Vat& vat, Real time) {
  if (vat.motion && vat.motion->stroke > 0) return true;
  if (vat.hand && is_moving(*vat.hand, time)) return true;
  return std::ranges::any_of(vat.walls, [](const Wall& wall) { return !wall.velocity.isZero(0); });
}

Real greatest_vat_speed(const Vat& vat, Real time) {
  Real speed = 0;
  if (vat.motion) speed += std::numbers::pi * std::abs(vat.motion->stroke) / vat.motion->period;
  if (vat.hand && is_moving(*vat.hand, time)) speed += std::numbers::sqrt3 * kMaxHandSpeed;
  return speed;
}

}  // namespace vat
