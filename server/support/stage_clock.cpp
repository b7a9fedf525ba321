#include "server/support/stage_clock.h"

#include <algorithm>

#include "core/support/check.h"

namespace vat {

void StageClock::stage_begins(std::string_view stage) {
  charge_running();
  running_ = find(stage);
  VAT_CHECK(running_ < stages_.size());
  ++stages_[running_].calls;
}

void StageClock::stages_end() {
  charge_running();
  running_ = kNone;
}

void StageClock::clear() {
  for (Stage& stage : stages_) stage = {.name = stage.name};
  spans_.clear();
}

void StageClock::charge_running() {
  const Clock::time_point now = now_();
  if (running_ != kNone) {
    stages_[running_].time += now - since_;
    if (spans_.size() < kMaxSpans) spans_.push_back({stages_[running_].name, since_, now});
  }
  since_ = now;
}

// A name is usually the same literal as before. Characters are compared only if it is not.
std::size_t StageClock::find(std::string_view name) {
  const auto is_same_literal = [name](const Stage& s) { return s.name.data() == name.data(); };
  auto found = std::ranges::find_if(stages_, is_same_literal);
  if (found == stages_.end()) found = std::ranges::find(stages_, name, &Stage::name);
  if (found == stages_.end()) found = stages_.insert(found, {.name = name});
  return static_cast<std::size_t>(found - stages_.begin());
}

}  // namespace vat
