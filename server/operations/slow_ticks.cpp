#include "server/operations/slow_ticks.h"

#include <map>
#include <string_view>
#include <utility>

#include "core/support/check.h"
#include "protocol/json/json_reader.h"

namespace vat {
namespace {

using Microseconds = std::chrono::duration<double, std::micro>;

Json event(std::string_view name, std::size_t session, SlowTick::Time begin, SlowTick::Time end) {
  VAT_CHECK(begin <= end);
  return {{"name", name},
          {"ph", "X"},  // a complete event: begin and duration
          {"pid", 1},
          {"tid", session},
          {"ts", Microseconds(begin.time_since_epoch()).count()},
          {"dur", Microseconds(end - begin).count()}};
}

void add_tick(Json& events, const SlowTick& tick, std::size_t session) {
  Json whole = event("tick " + std::to_string(tick.tick), session, tick.begin, tick.published);
  whole["args"] = {{"period", Microseconds(tick.period).count()},
                   {"late", Microseconds(tick.begin - tick.due).count()}};
  events.push_back(std::move(whole));
  events.push_back(event("steps", session, tick.begin, tick.stepped));
  for (const StageClock::Span& stage : tick.stages) {
    events.push_back(event(stage.name, session, stage.begin, stage.end));
  }
  events.push_back(event("publish", session, tick.stepped, tick.published));
}

}  // namespace

void SlowTicks::add(SlowTick tick) {
  const std::lock_guard lock(mutex_);
  if (ticks_.size() == kMaxTicks) ticks_.pop_front();
  ticks_.push_back(std::move(tick));
}

std::string SlowTicks::trace() const {
  // A session that adds a tick waits for the copy only.
  std::unique_lock lock(mutex_);
  const std::deque<SlowTick> ticks = ticks_;
  lock.unlock();
  Json events = Json::array();
  std::map<std::string_view, std::size_t> sessions;
  for (const SlowTick& tick : ticks) {
    const auto [session, is_new] = sessions.emplace(tick.session, sessions.size() + 1);
    if (is_new) {
      events.push_back({{"name", "thread_name"},
                        {"ph", "M"},
                        {"pid", 1},
                        {"tid", session->second},
                        {"args", {{"name", "session " + tick.session}}}});
    }
    add_tick(events, tick, session->second);
  }
  return Json{{"displayTimeUnit", "ms"}, {"traceEvents", std::move(events)}}.dump();
}

}  // namespace vat
