#include "tests/bench/speed/stage_clock.h"

#include <algorithm>

#include "core/support/check.h"

namespace vat::bench {

void StageClock::charge_running(Clock::time_point now) {
  if (!running_.empty()) {
    stages_[running_.back()].seconds += std::chrono::duration<Real>(now - since_).count();
  }
  since_ = now;
}

void StageClock::stage_begins(std::string_view stage) {
  charge_running(Clock::now());
  auto found = std::ranges::find(stages_, stage, &Stage::name);
  if (found == stages_.end()) found = stages_.insert(found, {std::string(stage), 0});
  running_.push_back(static_cast<std::size_t>(found - stages_.begin()));
}

void StageClock::stage_ends(std::string_view stage) {
  VAT_CHECK(!running_.empty() && stages_[running_.back()].name == stage);
  charge_running(Clock::now());
  running_.pop_back();
}

}  // namespace vat::bench
