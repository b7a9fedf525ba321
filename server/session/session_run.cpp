#include "server/session/session_run.h"

#include <utility>

namespace vat {

SessionRun::SessionRun(Simulation simulation, ServerMetrics& metrics)
    : metrics_(metrics), simulation_(std::move(simulation)), as_loaded_(simulation_.snapshot()) {}

void SessionRun::resume(Simulation simulation, Snapshot as_loaded, std::uint64_t position,
                        std::uint64_t tick, std::uint32_t epoch) {
  simulation_ = std::move(simulation);
  as_loaded_ = std::move(as_loaded);
  position_ = position;
  tick_ = tick;
  epoch_ = epoch;
}

void SessionRun::load(Simulation simulation) {
  simulation_ = std::move(simulation);
  as_loaded_ = simulation_.snapshot();
  profile_ = {};
  tick_ = 0;
  ++epoch_;
}

void SessionRun::reset() {
  simulation_.restore(as_loaded_);
  tick_ = 0;
  ++epoch_;
}

AdvanceReport SessionRun::advance() {
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
