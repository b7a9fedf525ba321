#include "core/stage/advance_report.h"

#include <algorithm>

namespace vat {

void AdvanceReport::count_steps(std::uint64_t count, Real least, Real greatest) {
  least_step = steps == 0 ? least : std::min(least_step, least);
  greatest_step = std::max(greatest_step, greatest);
  steps += count;
}

void AdvanceReport::add(const GuardEvent& event) {
  ++undone_steps;
  if (events.size() < kMaxEvents) {
    events.push_back(event);
  } else {
    events.back() = event;
  }
}

}  // namespace vat
