#include "server/session/core/session_run.h"

#include <algorithm>
#include <utility>

#include "core/support/check.h"
#include "server/session/core/scene_loading.h"

namespace vat {
namespace {

Resources greater(const Resources& a, const Resources& b) {
  return {std::max(a.particles, b.particles), std::max(a.springs, b.springs)};
}

}  // namespace

SessionRun::SessionRun(Simulation simulation, ResourceShare share, ServerMetrics& metrics)
    : metrics_(metrics),
      simulation_(std::move(simulation)),
      as_loaded_(simulation_.snapshot()),
      needed_as_loaded_(resources_of(simulation_)),
      share_(std::move(share)) {}

std::optional<LimitExcess> SessionRun::admit(const Simulation& next) {
  return share_.resize(resources_of(next));
}

std::optional<LimitExcess> SessionRun::admit(const Simulation& next, const Simulation& as_loaded) {
  return share_.resize(greater(resources_of(next), resources_of(as_loaded)));
}

std::optional<LimitExcess> SessionRun::admit_change() {
  return share_.resize(greater(resources_of(simulation_), needed_as_loaded_));
}

void SessionRun::resume(Simulation simulation, Snapshot as_loaded, const SessionMoment& moment) {
  simulation_ = std::move(simulation);
  as_loaded_ = std::move(as_loaded);
  needed_as_loaded_ = resources_of(simulation_);
  position_ = moment.position;
  tick_ = moment.tick;
  epoch_ = moment.epoch;
  last_grab_ = moment.last_grab;
}

void SessionRun::resize_share_anyway() {
  share_.resize_anyway(resources_of(simulation_));
}

void SessionRun::load(Simulation simulation) {
  simulation_ = std::move(simulation);
  as_loaded_ = simulation_.snapshot();
  needed_as_loaded_ = resources_of(simulation_);
  profile_ = {};
  tick_ = 0;
  ++epoch_;
}

void SessionRun::restore(Simulation simulation, const Simulation& as_loaded, std::uint64_t tick) {
  load(std::move(simulation));
  as_loaded_ = as_loaded.snapshot();
  needed_as_loaded_ = resources_of(as_loaded);
  tick_ = tick;
}

void SessionRun::reset() {
  simulation_.restore(as_loaded_);
  share_.resize_anyway(needed_as_loaded_);
  tick_ = 0;
  ++epoch_;
}

DeviceChoice SessionRun::device() const {
  if (!simulation_.has_engine()) return {};
  return as_loaded_.scene().numerics.device.value_or(DeviceChoice{});
}

AdvanceReport SessionRun::advance() {
  VAT_CHECK(simulation_.steps_per_tick() > 0);
  simulation_.set_observer(profile_.next_observer());
  const auto begin = TickProfile::Clock::now();
  AdvanceReport report = simulation_.advance(simulation_.steps_per_tick());
  profile_.tick_done(TickProfile::Clock::now() - begin, report, metrics_);
  if (!report.failed) {
    ++tick_;
    ++position_;
  }
  return report;
}

}  // namespace vat
