#include "server/cli/simulate/simulate_schedule.h"

#include <algorithm>
#include <cmath>

#include "core/limits.h"
#include "protocol/files/text.h"

namespace vat {

namespace {

constexpr Real kWholeTolerance = 1e-9;  // relative; far above round-off, far below any real misfit

// Greatest shortening of a step to meet the end of the run. Otherwise the end is moved.
constexpr Real kMaxShortening = 10;
constexpr int kMaxTries = 100'000;

bool is_whole(Real interval, Real step) {
  const Real count = std::round(interval / step);
  return std::abs(count * step - interval) <= kWholeTolerance * interval;
}

std::string seconds(Real value) {
  std::string text;
  append_number(text, value);
  return text + " s";
}

}  // namespace

std::uint64_t Schedule::output_count() const {
  const std::uint64_t multiples = total_steps / steps_per_output;
  return 1 + multiples + (total_steps % steps_per_output != 0 ? 1 : 0);
}

namespace {

/// The longest step up to the wanted one that `every` and, if it can be had, `until` are whole
/// numbers of.
Real fitted_step(Real wanted_step, Real every, Real until) {
  const Real fewest = is_whole(every, wanted_step) ? std::round(every / wanted_step)
                                                   : std::ceil(every / wanted_step);
  const Real longest = is_whole(every, wanted_step) ? wanted_step : every / fewest;
  if (is_whole(until, longest)) return longest;
  for (int more = 1; more <= kMaxTries && fewest + more <= kMaxShortening * fewest; ++more) {
    const Real shorter = every / (fewest + more);
    if (is_whole(until, shorter)) return shorter;
  }
  return longest;
}

}  // namespace

Schedule make_schedule(Real wanted_step, Real every, Real until) {
  Schedule schedule;
  schedule.step = fitted_step(wanted_step, every, until);
  if (schedule.step != wanted_step) {
    schedule.notices.push_back("the step is " + seconds(schedule.step) + " instead of " +
                               seconds(wanted_step) +
                               ": output interval and end must be whole numbers of steps");
  }
  schedule.steps_per_output = static_cast<std::uint64_t>(std::round(every / schedule.step));
  schedule.total_steps = static_cast<std::uint64_t>(std::round(until / schedule.step));
  if (!is_whole(until, schedule.step)) {
    const Real end = static_cast<Real>(schedule.total_steps) * schedule.step;
    schedule.notices.push_back("the run ends at " + seconds(end) + " instead of " + seconds(until) +
                               ", after a whole number of steps");
  }
  return schedule;
}

Numerics with_step(const Numerics& numerics, Real step) {
  Numerics fitted = numerics;
  fitted.step = step;
  if (is_whole(numerics.tick, step) &&
      std::round(numerics.tick / step) <= static_cast<Real>(kMaxStepsPerTick)) {
    return fitted;
  }
  const Real most = std::min(std::floor(kMaxTick / step), static_cast<Real>(kMaxStepsPerTick));
  fitted.tick = step * std::clamp(std::round(numerics.tick / step), 1.0, most);
  return fitted;
}

}  // namespace vat
