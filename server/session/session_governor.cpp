#include "server/session/session_governor.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/support/check.h"
#include "protocol/scene/numerics_change.h"
#include "server/support/log.h"

namespace vat {
namespace {

using Seconds = std::chrono::duration<double>;

SessionCommand make_switch(const SessionEnvironment& environment, const GovernorPoint& point) {
  return environment.methods.make("world.set_numerics", write_numerics_change(point.numerics));
}

}  // namespace

void SessionGovernor::add_tick(SteadyClock::duration time) {
  busy_ += time;
  ++ticks_;
}

std::optional<SessionCommand> SessionGovernor::next_command(const SessionCore& core,
                                                            SteadyClock::time_point now,
                                                            SteadyClock::duration period) {
  const std::span<const GovernorPoint> points = core.history().governor_points();
  if (!std::ranges::equal(points, points_)) {
    points_.assign(points.begin(), points.end());
    governor_ = {};
  }
  const auto point = find_point(points, core.run().simulation().scene());
  const bool is_measured = point && period > SteadyClock::duration::zero();
  if (is_measured && sampled_ && ticks_ == 0) return {};  // a slow tick is measured as a whole
  const std::uint64_t ticks = std::exchange(ticks_, 0);
  const Seconds busy = std::exchange(busy_, {});
  if (!is_measured) {
    governor_.restart();
    sampled_.reset();
    return {};
  }
  const auto begin = std::exchange(sampled_, now);
  if (!begin || ticks == 0) return {};
  const GovernorSample sample{Seconds(now - *begin).count(), core.clock().is_slow(),
                              busy / (static_cast<double>(ticks) * Seconds(period))};
  const auto next = governor_.add(sample, *point, points_);
  if (!next) return {};
  switch_ = Switch{*next, *next > *point};
  return make_switch(core.environment(), points_[*next]);
}

void SessionGovernor::tell_switch(SessionCore& core) {
  const std::optional<Switch> made = std::exchange(switch_, std::nullopt);
  if (!made) return;
  VAT_CHECK(made->point < points_.size());
  if (find_point(points_, core.run().simulation().scene()) != made->point) {
    log_warning("session {}: the governor could not change to point {}", core.id(), made->point);
    return governor_.fail(made->point);
  }
  core.participants().send_event(
      write_event("governor.switched", {{"tick", core.run().tick()},
                                        {"point", made->point},
                                        {"error", points_[made->point].error},
                                        {"reason", made->is_cheaper ? "behind" : "reserve"}}));
  core.notifier().mark_status();
}

}  // namespace vat
