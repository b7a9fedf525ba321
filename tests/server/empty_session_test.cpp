// Sessions that nobody is in stand still after a while, and end after a longer one.

#include <thread>

#include "tests/server/session_fixture.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::empty_session_test {
namespace {

using std::chrono::milliseconds;

ServerLimits soon_still() {
  ServerLimits limits;
  limits.resume_time = milliseconds(100);
  limits.hibernate_after = milliseconds(300);
  return limits;
}

ServerLimits soon_gone() {
  ServerLimits limits = soon_still();
  limits.expire_after = milliseconds(1500);
  return limits;
}

class EmptySession : public SessionTest {
 protected:
  explicit EmptySession(const ServerLimits& limits = soon_still()) : SessionTest(limits) {}

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
  bool is_one_still() {
    return server.metrics().find("vat_sessions{state=\"hibernating\"} 1\n") != std::string::npos;
  }
  /// The tick at which the session stands, once it does.
  std::uint64_t standing_tick(const std::string& session) {
    while (!is_one_still()) std::this_thread::sleep_for(milliseconds(20));
    const std::uint64_t tick = listed(session).at("tick");
    std::this_thread::sleep_for(milliseconds(200));
    EXPECT_EQ(listed(session).at("tick"), tick) << "ten periods later";
    return tick;
  }
};

TEST_F(EmptySession, StandsStillAndGoesOnWhereItStood) {
  const std::string session = create();
  const std::uint64_t stood = standing_tick(session);
  EXPECT_GT(stood, 0U) << "it has played for a while";
  const auto visitor = join(session);
  EXPECT_TRUE(listed(session).at("playing"));
  visitor->wait_event("session.status", [&](const Json& s) { return s.at("tick") > stood + 5; });
  EXPECT_FALSE(is_one_still());
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
  while (listed(session).at("tick") == before) std::this_thread::sleep_for(milliseconds(20));
}

class ExpiringSession : public EmptySession {
 protected:
  ExpiringSession() : EmptySession(soon_gone()) {}
};

TEST_F(ExpiringSession, EndsAfterAWhileButNotTheFirst) {
  const auto begin = std::chrono::steady_clock::now();
  const std::string session = create();
  client->result("session.leave");
  while (!listed(session).is_null()) std::this_thread::sleep_for(milliseconds(20));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(1500));
  std::this_thread::sleep_for(milliseconds(1000));
  EXPECT_FALSE(listed("s1").is_null());
}

TEST_F(ExpiringSession, WithSomebodyInItDoesNotEnd) {
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

TEST(EmptyReplay, EndsAfterAWhileThoughSessionsDoNot) {
  const TemporaryFolder folder;
  const Catalogue catalogue = make_catalogue();
  ServerSettings settings;
  settings.data_folder = folder.file("data");
  settings.limits.resume_time = milliseconds(100);
  settings.limits.expire_after = milliseconds(0);
  settings.limits.replay_expire_after = milliseconds(1500);
  SessionServer server(catalogue, settings);
  ASSERT_TRUE(server.create_session("first", to_scene(mixed_scene_text())).ok());
  TestClient client(server, 1);
  client.result("session.create", {{"name", "n"}, {"scene", "mixed"}});
  client.result("session.join", {{"session", "s1"}});
  const auto sessions = [&] { return client.result("session.list").at("sessions").size(); };
  const Json replay = client.result("replay.open", {{"session", "s1"}}).at("session");
  client.result("session.join", {{"session", replay}});
  std::this_thread::sleep_for(milliseconds(3000));
  EXPECT_EQ(sessions(), 3U) << "somebody is in the replay";
  client.result("session.join", {{"session", "s1"}});
  while (sessions() == 3) std::this_thread::sleep_for(milliseconds(20));
  EXPECT_EQ(client.error("session.join", {{"session", replay}}).at("code"), 1002);
  EXPECT_EQ(sessions(), 2U);
}

}  // namespace
}  // namespace vat::test::empty_session_test
