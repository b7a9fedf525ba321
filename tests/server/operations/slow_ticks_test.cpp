#include "server/operations/slow_ticks.h"

#include "tests/server/fixture/session_fixture.h"

namespace vat::test::slow_ticks_test {
namespace {

using namespace std::chrono_literals;

constexpr SlowTick::Time kStart{1s};

SlowTick slow_tick(const std::string& session, std::uint64_t tick) {
  return {session,
          tick,
          20ms,
          kStart,
          kStart + 2ms,
          kStart + 32ms,
          kStart + 35ms,
          {{"walls", kStart + 2ms, kStart + 7ms}, {"kick", kStart + 7ms, kStart + 32ms}}};
}

TEST(SlowTicks, AreATraceOfChrome) {
  SlowTicks ticks;
  EXPECT_EQ(Json::parse(ticks.trace()).at("traceEvents"), Json::array());
  ticks.add(slow_tick("s1", 7));
  // Times in microseconds.
  EXPECT_EQ(Json::parse(ticks.trace()), Json::parse(R"({"displayTimeUnit": "ms", "traceEvents": [
    {"name": "thread_name", "ph": "M", "pid": 1, "tid": 1, "args": {"name": "session s1"}},
    {"name": "tick 7", "ph": "X", "pid": 1, "tid": 1, "ts": 1002000.0, "dur": 33000.0,
     "args": {"period": 20000.0, "late": 2000.0}},
    {"name": "steps", "ph": "X", "pid": 1, "tid": 1, "ts": 1002000.0, "dur": 30000.0},
    {"name": "walls", "ph": "X", "pid": 1, "tid": 1, "ts": 1002000.0, "dur": 5000.0},
    {"name": "kick", "ph": "X", "pid": 1, "tid": 1, "ts": 1007000.0, "dur": 25000.0},
    {"name": "publish", "ph": "X", "pid": 1, "tid": 1, "ts": 1032000.0, "dur": 3000.0}]})"));
}

/// Returns the names of the events with this thread, without the stages.
std::vector<std::string> ticks_of(const Json& trace, int thread) {
  std::vector<std::string> names;
  for (const Json& event : trace.at("traceEvents")) {
    const std::string name = event.at("name");
    if (event.at("tid") == thread && name.starts_with("tick ")) names.push_back(name);
  }
  return names;
}

TEST(SlowTicks, AreTheLastOfAllSessions) {
  SlowTicks ticks;
  for (std::uint64_t tick = 0; tick < SlowTicks::kMaxTicks; ++tick) {
    ticks.add(slow_tick(tick < 3 ? "first" : "second", tick));
  }
  const Json trace = Json::parse(ticks.trace());
  EXPECT_EQ(ticks_of(trace, 1), (std::vector<std::string>{"tick 0", "tick 1", "tick 2"}));
  EXPECT_EQ(ticks_of(trace, 2).size(), SlowTicks::kMaxTicks - 3);
  ticks.add(slow_tick("first", 100));
  const Json next = Json::parse(ticks.trace());
  EXPECT_EQ(ticks_of(next, 1), (std::vector<std::string>{"tick 1", "tick 2", "tick 100"}));
}

class SlowTicksOfSessions : public SessionTest {};

// A period of one microsecond is shorter than the steps on any machine.
TEST_F(SlowTicksOfSessions, HaveTheStages) {
  Json scene = Json::parse(mixed_scene_text());
  scene["numerics"]["tick"] = 1e-6;
  scene["numerics"]["step"] = 1e-7;
  client->result("scene.load", {{"scene", scene}});
  client->result("control.step", {{"ticks", 2}});
  EXPECT_EQ(Json::parse(server.slow_ticks()).at("traceEvents"), Json::array())
      << "single steps have no period";
  client->result("control.play");
  // The profile samples some of these ticks.
  server.advance_until([&] { return server.slow_ticks().find("\"kick\"") != std::string::npos; });
  const std::string trace = server.slow_ticks();
  for (const char* name : {"session s1", "steps", "springs", "walls", "publish"}) {
    EXPECT_NE(trace.find('"' + std::string(name) + '"'), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace vat::test::slow_ticks_test
