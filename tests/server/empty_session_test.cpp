// Sessions that nobody is in stand still after a while, and end after a longer one.

#include <thread>

#include "tests/server/session_fixture.h"

namespace vat::test {
namespace {

using std::chrono::milliseconds;

ServerLimits short_times() {
  ServerLimits limits;
  limits.resume_time = milliseconds(100);
  limits.hibernate_after = milliseconds(300);
  limits.expire_after = milliseconds(1500);
  return limits;
}

class EmptySession : public SessionTest {
 protected:
  EmptySession() : SessionTest(short_times()) {}

  /// As session.list tells it; null where it has ended.
  Json listed(const std::string& session) {
    const Json sessions = client->result("session.list").at("sessions");
    for (const Json& entry : sessions) {
      if (entry.at("session") == session) return entry;
    }
    return nullptr;
  }
  std::string create() {
    return client->result("session.create", {{"name", "n"}, {"scene", "mixed"}}).at("session");
  }
  /// The tick, once it has not changed for ten times its period.
  std::uint64_t standing_tick(const std::string& session) {
    std::uint64_t tick = listed(session).at("tick");
    for (;;) {
      std::this_thread::sleep_for(milliseconds(200));
      if (std::exchange(tick, listed(session).at("tick")) == tick) return tick;
    }
  }
};

TEST_F(EmptySession, StandsStillAndGoesOnWhereItStood) {
  const std::string session = create();
  const std::uint64_t stood = standing_tick(session);
  EXPECT_GT(stood, 5U) << "it has played for a while";
  EXPECT_NE(server.metrics().find("vat_sessions{state=\"hibernating\"} 1\n"), std::string::npos);
  const auto visitor = join(session);
  EXPECT_TRUE(listed(session).at("playing"));
  visitor->wait_event("session.status", [&](const Json& s) { return s.at("tick") > stood + 5; });
  EXPECT_EQ(server.metrics().find("vat_sessions{state=\"hibernating\"} 1\n"), std::string::npos);
}

// Its steps are those of a session that was never empty.
TEST_F(EmptySession, ThatHasStoodStillHasTheSameBits) {
  const std::string session = create();
  standing_tick(session);
  const auto visitor = join(session);
  visitor->result("control.pause");
  visitor->result("control.step", {{"ticks", 7}});
  const Json state = visitor->result("session.hash");
  Simulation expected = Simulation::create(to_scene(mixed_scene_text())).value();
  advance_ticks(expected, state.at("tick"));
  EXPECT_EQ(state.at("hash"), hash_of(expected));
}

TEST_F(EmptySession, WithSomebodyInItPlaysOn) {
  const std::string session = create();
  const auto visitor = join(session);
  std::this_thread::sleep_for(milliseconds(700));
  const std::uint64_t before = listed(session).at("tick");
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_GT(listed(session).at("tick"), before);
}

TEST_F(EmptySession, EndsAfterAWhileButNotTheFirst) {
  const std::string session = create();
  client->result("session.leave");
  const auto begin = std::chrono::steady_clock::now();
  while (!listed(session).is_null()) std::this_thread::sleep_for(milliseconds(20));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(1400));
  std::this_thread::sleep_for(milliseconds(1000));
  EXPECT_FALSE(listed("s1").is_null());
}

TEST_F(EmptySession, WithSomebodyInItDoesNotEnd) {
  const std::string session = create();
  const auto visitor = join(session);
  std::this_thread::sleep_for(milliseconds(2500));
  EXPECT_FALSE(listed(session).is_null());
  visitor->disconnect();
  while (!listed(session).is_null()) std::this_thread::sleep_for(milliseconds(20));
}

class NeverIdle : public SessionTest {
 protected:
  static ServerLimits never() {
    ServerLimits limits;
    limits.hibernate_after = limits.expire_after = milliseconds(0);
    return limits;
  }
  NeverIdle() : SessionTest(never()) {}
};

TEST_F(NeverIdle, PlaysOnWithNobodyInIt) {
  const std::string session =
      client->result("session.create", {{"name", "n"}, {"scene", "mixed"}}).at("session");
  std::this_thread::sleep_for(milliseconds(700));
  EXPECT_NE(server.metrics().find("vat_sessions{state=\"playing\"} 1\n"), std::string::npos);
}

}  // namespace
}  // namespace vat::test
