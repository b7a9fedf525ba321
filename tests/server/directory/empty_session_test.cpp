// Sessions without clients hibernate after some time, and end after a longer time.

#include "tests/server/fixture/session_fixture.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::empty_session_test {
namespace {

using namespace std::chrono_literals;

constexpr auto kResumeTime = 2s;
constexpr auto kHibernateAfter = 10s;
constexpr auto kExpireAfter = 60s;
constexpr auto kStatusInterval = 500ms;  // interval of a session's status
constexpr auto kExpiryCheck = 15s;       // interval of the server's check of expired sessions

class EmptySession : public SessionTest {
 protected:
  explicit EmptySession(const ServerLimits& limits = short_times()) : SessionTest(limits) {}
  static ServerLimits short_times() {
    ServerLimits limits = unhurried_limits();
    limits.resume_time = kResumeTime;
    limits.hibernate_after = kHibernateAfter;
    limits.expire_after = 0s;
    return limits;
  }

  /// Returns the entry of session.list; null if the session has ended.
  Json listed(const std::string& session) {
    const Json sessions = client->result("session.list").at("sessions");
    for (const Json& entry : sessions) {
      if (entry.at("session") == session) return entry;
    }
    return nullptr;
  }
  std::uint64_t tick_of(const std::string& session) { return listed(session).at("tick"); }
  std::string create() {
    return client->result("session.create", {{"name", "n"}, {"scene", "mixed"}}).at("session");
  }
  /// Returns the number of sessions in a state.
  std::string count(const std::string& state) {
    const std::string metrics = server.metrics();
    const std::string name = "vat_sessions{state=\"" + state + "\"} ";
    const std::size_t begin = metrics.find(name) + name.size();
    return metrics.substr(begin, metrics.find('\n', begin) - begin);
  }
};

TEST_F(EmptySession, HibernatesInTimeAndContinuesWhenSomebodyJoins) {
  const std::string session = create();
  server.clock().advance(kHibernateAfter - kStatusInterval);
  EXPECT_EQ(count("playing"), "1");
  server.clock().advance(2 * kStatusInterval);
  EXPECT_EQ(count("hibernating"), "1");
  const std::uint64_t tick = tick_of(session);
  EXPECT_NEAR(static_cast<double>(tick), 10 / 0.02, 0.5 / 0.02)
      << "the session has played for ten seconds";
  server.clock().advance(10s);
  EXPECT_EQ(tick_of(session), tick);
  const auto visitor = join(session);
  EXPECT_TRUE(listed(session).at("playing"));
  server.clock().advance(1s);
  EXPECT_EQ(tick_of(session), tick + 50);
  EXPECT_EQ(count("hibernating"), "0");
}

// A hibernated session continues with the same bits as a session that was never empty.
TEST_F(EmptySession, ThatHasHibernatedHasTheSameBits) {
  const std::string session = create();
  server.clock().advance(2 * kHibernateAfter);
  ASSERT_EQ(count("hibernating"), "1");
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
  server.clock().advance(2 * kHibernateAfter);
  const std::uint64_t before = tick_of(session);
  server.clock().advance(1s);
  EXPECT_EQ(tick_of(session), before + 50);
}

// The participant may resume.
TEST_F(EmptySession, IsNotEmptyWhileSomebodyIsAway) {
  const std::string session = create();
  join(session)->disconnect();
  server.clock().advance(kHibernateAfter + kStatusInterval);
  EXPECT_EQ(count("playing"), "1");
  server.clock().advance(kResumeTime);
  EXPECT_EQ(count("hibernating"), "1");
}

class ExpiringSession : public EmptySession {
 protected:
  ExpiringSession() : EmptySession(expiring()) {}
  static ServerLimits expiring() {
    ServerLimits limits = short_times();
    limits.expire_after = kExpireAfter;
    return limits;
  }
};

TEST_F(ExpiringSession, EndsInTimeButNotTheFirst) {
  const std::string session = create();
  client->result("session.leave");
  server.clock().advance(kExpireAfter - kStatusInterval);
  EXPECT_FALSE(listed(session).is_null());
  server.clock().advance(kExpiryCheck + kStatusInterval);
  EXPECT_TRUE(listed(session).is_null());
  server.clock().advance(kExpireAfter);
  EXPECT_FALSE(listed("s1").is_null());
}

TEST_F(ExpiringSession, WithSomebodyInItDoesNotEnd) {
  const std::string session = create();
  const auto visitor = join(session);
  visitor->result("control.pause");
  server.clock().advance(2 * kExpireAfter);
  EXPECT_FALSE(listed(session).is_null());
  visitor->disconnect();
  server.clock().advance(kExpireAfter);
  EXPECT_FALSE(listed(session).is_null()) << "its participant was disconnected at first";
  server.clock().advance(kResumeTime + kExpiryCheck);
  EXPECT_TRUE(listed(session).is_null());
}

class NeverIdle : public EmptySession {
 protected:
  NeverIdle() : EmptySession(never()) {}
  static ServerLimits never() {
    ServerLimits limits = unhurried_limits();
    limits.hibernate_after = limits.expire_after = 0ms;
    return limits;
  }
};

TEST_F(NeverIdle, PlaysWithoutParticipants) {
  create();
  server.clock().advance(30s);
  EXPECT_EQ(count("playing"), "1");
}

TEST(EmptyReplay, EndsInTimeThoughSessionsDoNot) {
  const TemporaryFolder folder;
  const Catalogue catalogue = make_catalogue();
  ServerLimits limits = unhurried_limits();
  limits.resume_time = kResumeTime;
  limits.hibernate_after = 1s;
  limits.expire_after = 0ms;
  limits.replay_expire_after = kExpireAfter;
  TestServer server(catalogue, test_settings(limits, folder.file("data")));
  ASSERT_TRUE(server.create_session("first", to_scene(mixed_scene_text())).ok());
  TestClient client(server, 1);
  client.result("session.create", {{"name", "n"}, {"scene", "mixed"}});
  client.result("session.join", {{"session", "s1"}});
  client.result("control.pause");
  const auto sessions = [&] { return client.result("session.list").at("sessions").size(); };
  const Json replay = client.result("replay.open", {{"session", "s1"}}).at("session");
  client.result("session.join", {{"session", replay}});
  server.clock().advance(2 * kExpireAfter);
  EXPECT_EQ(sessions(), 3U) << "a client is in the replay";
  client.result("session.join", {{"session", "s1"}});
  server.clock().advance(kExpireAfter - 1s);
  EXPECT_EQ(sessions(), 3U);
  server.clock().advance(1s + kExpiryCheck);
  EXPECT_EQ(client.error("session.join", {{"session", replay}}).at("code"), 1002);
  EXPECT_EQ(sessions(), 2U);
}

// Work of sessions without commands and ticks.

class IdleSession : public SessionTest {};

// A client is connected, so statuses continue.
TEST_F(IdleSession, WakesForItsStatusesOnly) {
  client->result("frames.subscribe");
  client->wait_frame([](const GridFrame&) { return true; });
  server.clock().advance(
      1s);  // lets the first frame be acknowledged and the last heartbeat be sent
  const std::size_t frames = client->connection->frame_count();
  const std::size_t tasks = server.clock().tasks_run();
  client->mark();
  server.clock().advance(10s);
  EXPECT_EQ(client->connection->frame_count(), frames);
  EXPECT_EQ(client->events("session.status").size(), 20U);
  EXPECT_LE(server.clock().tasks_run() - tasks, 20U + 1)
      << "one more for the check of expired sessions";
}

TEST_F(IdleSession, EmptyWakesOnlyForStatuses) {
  client->result("session.leave");
  server.clock().advance(1s);
  const std::size_t tasks = server.clock().tasks_run();
  server.clock().advance(10s);
  EXPECT_LE(server.clock().tasks_run() - tasks, 20U + 1);
}

}  // namespace
}  // namespace vat::test::empty_session_test
