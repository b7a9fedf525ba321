#include "core/stage/advance_report.h"

#include <algorithm>

#include "core/support/check.h"

namespace vat {

const char* to_string(GuardEvent::Cause cause) {
  switch (cause) {
    case GuardEvent::Cause::non_finite:
      return "non_finite";
    case GuardEvent::Cause::outside_domain:
      return "outside_domain";
    case GuardEvent::Cause::too_fast:
      return "too_fast";
    case GuardEvent::Cause::too_many_pairs:
      return "too_many_pairs";
  }
  VAT_CHECK(false && "not a cause");
  return "";
}

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
