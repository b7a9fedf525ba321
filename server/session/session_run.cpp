#include "server/session/session_run.h"

#include <utility>

namespace vat {

SessionRun::SessionRun(Simulation simulation)
    : simulation_(std::move(simulation)), as_loaded_(simulation_.snapshot()) {}

void SessionRun::load(Simulation simulation) {
  simulation_ = std::move(simulation);
  as_loaded_ = simulation_.snapshot();
  tick_ = 0;
  ++epoch_;
}

void SessionRun::reset() {
  simulation_.restore(as_loaded_);
  tick_ = 0;
  ++epoch_;
}

AdvanceReport SessionRun::advance() {
  AdvanceReport report = simulation_.advance(simulation_.steps_per_tick());
  if (!report.failed) ++tick_;
  return report;
}

}  // namespace vat
